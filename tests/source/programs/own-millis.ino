#include <micro_ros_arduino.h>
const unsigned long INTERVAL = 1000 / 40;
unsigned long previous = 0;
void publish_imu() { imu.header.stamp = now(); RCSOFTCHECK(rcl_publish(&imu_publisher, &imu, NULL)); }
void setup() {
  set_microros_transports();
  RCCHECK(rclc_node_init_default(&node, "imu", "", &support));
  RCCHECK(rclc_publisher_init_best_effort(&imu_publisher, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(geometry_msgs, msg, Twist), "imu"));
  RCCHECK(rclc_subscription_init_default(&cmd, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Bool), "calibrate"));
  RCCHECK(rclc_executor_init(&executor, &support.context, 1, &allocator));
  RCCHECK(rclc_executor_add_subscription(&executor, &cmd, &flag, &calibrate, ON_NEW_DATA));
}
void loop() {
  rclc_executor_spin_some(&executor, 0);
  if (millis() - previous >= INTERVAL) { previous = millis(); publish_imu(); }
}
