#include <micro_ros_arduino.h>
#define N 2
#define USE_ODOM 1
void create_pub(rcl_publisher_t *p, const char *t, bool best) {
  if (best) { RCCHECK(rclc_publisher_init_best_effort(p, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), t)); }
  else { RCCHECK(rclc_publisher_init_default(p, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), t)); }
}
void setup() {
  set_microros_transports();
  RCCHECK(rclc_support_init(&support, 0, NULL, &allocator));
  RCCHECK(rclc_node_init_default(&node, "n41", "", &support));
  create_pub(&pa, "a", true); create_pub(&pb, "b", false);
  String base = "motor";
  for (int i = 0; i < N; i++) {
    String topic = base + String(i) + "/state";
    RCCHECK(rclc_publisher_init_default(&pm[i], &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), topic.c_str()));
    if (i == 0) { RCCHECK(rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(100), cb)); }
  }
#if USE_ODOM == 1
  RCCHECK(rclc_publisher_init_default(&po, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(nav_msgs, msg, Odometry), "odom"));
#else
  RCCHECK(rclc_publisher_init_default(&px, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(nav_msgs, msg, Path), "path"));
#endif
  RCCHECK(rclc_executor_init(&executor, &support.context, 1, &allocator));
  RCCHECK(rclc_executor_add_timer(&executor, &timer));
}
void cb(rcl_timer_t *t, int64_t l) { for (int i = 0; i < N; i++) { rcl_publish(&pm[i], &m, NULL); } if (t) rcl_publish(&pa, &m, NULL); }
void loop() { delay(10); rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10)); }
