// Arduino: one subscription that switches a lamp; the loop waits 100 ms in each turn.
#include <micro_ros_arduino.h>

rcl_subscription_t subscriber;

void lamp(const void * msgin) {
  digitalWrite(13, ((const std_msgs__msg__Int32 *) msgin)->data != 0);
}

void setup() {
  set_microros_transports();
  delay(2000);
  RCCHECK(rclc_support_init(&support, 0, NULL, &allocator));
  RCCHECK(rclc_node_init_default(&node, "lamp", "", &support));
  RCCHECK(rclc_subscription_init_default(&subscriber, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "lamp"));
  RCCHECK(rclc_executor_init(&executor, &support.context, 1, &allocator));
  RCCHECK(rclc_executor_add_subscription(&executor, &subscriber, &msg, &lamp, ON_NEW_DATA));
}

void loop() {
  delay(100);
  RCCHECK(rclc_executor_spin_some(&executor, RCL_MS_TO_NS(100)));
}
