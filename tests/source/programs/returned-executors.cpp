#include "FreeRTOS.h"
static rclc_executor_t drive, power;
static rcl_subscription_t wheels; static rcl_timer_t battery;
rclc_executor_t * drive_init(rcl_node_t * node, rclc_support_t * support, const rcl_allocator_t * allocator) {
  hal_init();
  guard(rclc_executor_init(&drive, &support->context, 1, allocator));
  guard(rclc_subscription_init_best_effort(&wheels, node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Float32), "wheels"));
  guard(rclc_executor_add_subscription(&drive, &wheels, &wheel_message, &on_wheels, ALWAYS));
  return &drive;
}
rclc_executor_t * power_init(rcl_node_t * node, rclc_support_t * support, const rcl_allocator_t * allocator) {
  guard(rclc_executor_init(&power, &support->context, 1, allocator));
  guard(rclc_timer_init_default2(&battery, support, RCL_S_TO_NS(1), &on_battery, true));
  guard(rclc_executor_add_timer(&power, &battery));
  return &power;
}
int main() {
  rcl_node_t node;
  guard(rclc_node_init_default(&node, "core", "", &support));
  rclc_executor_t * const first = drive_init(&node, &support, &allocator);
  rclc_executor_t * second = power_init(&node, &support, &allocator);
  while (true) {
    soft_guard(rclc_executor_spin_some(first, RCL_MS_TO_NS(1)));
    soft_guard(rclc_executor_spin_some(second, RCL_MS_TO_NS(2)));
  }
}
