#include <micro_ros_arduino.h>
#include "esp_system.h"
hw_timer_t *t = NULL; volatile bool flag = false;
void IRAM_ATTR isr() { flag = true; }
void setup() {
  set_microros_wifi_transports("a", "b", "1.1.1.1", 8888);
  RCCHECK(rclc_support_init(&support, 0, NULL, &allocator));
  RCCHECK(rclc_node_init_default(&node, "flag", "", &support));
  RCCHECK(rclc_publisher_init_best_effort(&p, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "adc"));
  RCCHECK(rclc_subscription_init_default(&s, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "pwm"));
  RCCHECK(rclc_executor_init(&executor, &support.context, 1, &allocator));
  RCCHECK(rclc_executor_add_subscription(&executor, &s, &m, &cb, ON_NEW_DATA));
}
void publishAdc() { if (flag) { flag = false; RCSOFTCHECK(rcl_publish(&p, &a, NULL)); } }
void loop() { publishAdc(); RCSOFTCHECK(rclc_executor_spin_some(&executor, RCL_MS_TO_NS(1))); while (millis() % 10) { yield(); } }
