#include "FreeRTOS.h"
#include "cmsis_os.h"
void StartDefaultTask(void *arg) {
  rclc_support_init(&support, 0, NULL, &allocator);
  rclc_node_init_default(&node, "qos", "ns", &support);
  rclc_publisher_init(&a, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int8), "a", &rmw_qos_profile_sensor_data);
  rmw_qos_profile_t q = rmw_qos_profile_default;
  q.reliability = RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT;
  q.depth = 1;
  rclc_subscription_init(&b, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int8), "b", &q);
  const rmw_qos_profile_t keep = { RMW_QOS_POLICY_HISTORY_KEEP_LAST, 3, RMW_QOS_POLICY_RELIABILITY_RELIABLE, RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL };
  rclc_publisher_init(&c, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int8), "c", &keep);
  rcl_publisher_options_t opt = rcl_publisher_get_default_options();
  opt.qos.reliability = RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT;
  rcl_publisher_init(&d, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int8), "d", &opt);
  rclc_executor_init(&executor, &support.context, 1, &allocator);
  rclc_executor_add_subscription_with_context(&executor, &b, &mb, &on_b, &ctx, ALWAYS);
  rclc_executor_set_trigger(&executor, rclc_executor_trigger_one, &b);
  rclc_executor_set_semantics(&executor, LET);
  for (;;) { rclc_executor_spin_some(&executor, RCL_MS_TO_NS(5)); osDelay(1); }
}
void on_b(const void *m, void *ctx) { rcl_publish(&a, &ma, NULL); rcl_publish(&c, &mc, NULL); rcl_publish(&d, &md, NULL); }
