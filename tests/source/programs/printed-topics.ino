#include <micro_ros_arduino.h>
#define NUM_SENSORS 4
rcl_publisher_t range_pub[NUM_SENSORS];
sensor_msgs__msg__Range range_msg[NUM_SENSORS];
void timer_cb(rcl_timer_t *t, int64_t d) { for (int i = 0; i < NUM_SENSORS; i++) rcl_publish(&range_pub[i], &range_msg[i], NULL); }
void setup() {
  set_microros_transports();
  rclc_support_init(&support, 0, NULL, &allocator);
  rclc_node_init_default(&node, "sonar", "", &support);
  for (int i = 0; i < NUM_SENSORS; i++) {
    char topic[20];
    snprintf(topic, sizeof(topic), "range_%d", i);
    rclc_publisher_init_best_effort(&range_pub[i], &node, ROSIDL_GET_MSG_TYPE_SUPPORT(sensor_msgs, msg, Range), topic);
  }
  rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(50), timer_cb);
  rclc_executor_init(&executor, &support.context, 1, &allocator);
  rclc_executor_add_timer(&executor, &timer);
}
void loop() { rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10)); }
