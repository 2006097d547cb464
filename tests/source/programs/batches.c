#include "esp_log.h"
void on_timer(rcl_timer_t * timer, int64_t last) {
  for (int i = 0; i < number_of_motors(); i++) { check(rcl_publish(&motor, &messages[i], NULL)); }
}
void app_main(void) {
  check(rclc_node_init_default(&node, "motors", "", &support));
  check(rclc_publisher_init_best_effort(&motor, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "motor"));
  check(rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(40), on_timer));
  check(rclc_executor_init(&executor, &support.context, 1, &allocator));
  check(rclc_executor_add_timer(&executor, &timer));
  rclc_executor_spin(&executor);
}
