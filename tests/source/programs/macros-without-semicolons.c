#include "FreeRTOS.h"
#include "cmsis_os.h"
#define STOP(label) if (rc != RCL_RET_OK) { goto label; }
#define NOTE() { if (rc != RCL_RET_OK) { count++; } }
void app(void * arg) {
  rcl_ret_t rc = rclc_support_init(&support, 0, NULL, &allocator);
  STOP(end)
  rcl_node_t node = rcl_get_zero_initialized_node();
  rc = rclc_node_init_default(&node, "sonar", "", &support);
  STOP(end)
  rcl_publisher_t range = rcl_get_zero_initialized_publisher();
  rc = rclc_publisher_init_best_effort(&range, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "range");
  STOP(end)
  rmw_uros_set_custom_transport(true, (void *) &hfdcan1, open, close, write, read);
  while (1) {
    rc = rcl_publish(&range, &message, NULL);
    NOTE()
    osDelay(pdMS_TO_TICKS(100));
  }
end:
  rc = rclc_support_fini(&support);
}
void app_other(void * arg) {
  rcl_node_t node = rcl_get_zero_initialized_node();
  STOP(end)
end:
  return;
}
int main(void) { xTaskCreate(app, "app", 3000, NULL, 2, NULL); }
