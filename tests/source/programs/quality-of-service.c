#include <zephyr/kernel.h>
#define TOPIC(name) "robot/" name
const rosidl_message_type_support_t * type(void) { return ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, UInt8); }
void main(void) {
  rmw_qos_profile_t own = rmw_qos_profile_sensor_data;
  own.depth = 1;
  check(rclc_node_init_default(&node, "q", "", &support));
  check(rclc_subscription_init(&a, &node, type(), "a", &rmw_qos_profile_sensor_data));
  check(rclc_subscription_init(&b, &node, type(), "b", &rmw_qos_profile_default));
  check(rclc_subscription_init(&c, &node, type(), "c", &own));
  check(rclc_subscription_init_default(&d, &node, type(), topic_from_flash()));
  check(rclc_executor_init(&executor, &support.context, 4, &allocator));
  check(rclc_executor_add_subscription(&executor, &a, &m, &on_a, ON_NEW_DATA));
  check(rclc_executor_add_subscription(&executor, &b, &m, &on_b, ON_NEW_DATA));
  check(rclc_executor_add_subscription(&executor, &c, &m, &on_c, ON_NEW_DATA));
  check(rclc_executor_add_subscription(&executor, &d, &m, &on_d, ON_NEW_DATA));
  while (1) { rclc_executor_spin_some(&executor, RCL_MS_TO_NS(100)); k_yield(); }
}
