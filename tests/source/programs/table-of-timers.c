#include "freertos/FreeRTOS.h"
static rcl_publisher_t pubs[3]; static rcl_timer_t timers[3];
static const struct { const char *topic; uint32_t ms; rcl_timer_callback_t cb; } table[] = { {"imu", 10, imu_cb}, {"gps", 1000, gps_cb}, {.topic = "bat", .ms = 5000, .cb = bat_cb} };
static void imu_cb(rcl_timer_t *t, int64_t l) { rcl_publish(&pubs[0], &m, NULL); }
static void gps_cb(rcl_timer_t *t, int64_t l) { rcl_publish(&pubs[1], &m, NULL); }
static void bat_cb(rcl_timer_t *t, int64_t l) { rcl_publish(&pubs[2], &m, NULL); }
void app_main(void) {
  rclc_support_init(&support, 0, NULL, &allocator);
  rclc_node_init_default(&node, "tab", "", &support);
  rclc_executor_init(&executor, &support.context, sizeof(table) / sizeof(table[0]), &allocator);
  for (int i = 0; i < 3; ++i) {
    rclc_publisher_init_default(&pubs[i], &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), table[i].topic);
    rclc_timer_init_default(&timers[i], &support, RCL_MS_TO_NS(table[i].ms), table[i].cb);
    rclc_executor_add_timer(&executor, &timers[i]);
  }
  while (1) { rclc_executor_spin_some(&executor, RCL_MS_TO_NS(5)); taskYIELD(); }
}
