#include <Arduino.h>
#include <micro_ros_platformio.h>
struct Entity { virtual bool begin(rcl_node_t * node, rclc_executor_t * executor) = 0; };
struct Lamp : Entity {
  rcl_subscription_t subscription;
  bool begin(rcl_node_t * node, rclc_executor_t * executor) override {
    if (rclc_subscription_init_default(&subscription, node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Bool), "lamp") != RCL_RET_OK) return false;
    return rclc_executor_add_subscription(executor, &subscription, &message, &on_lamp, ON_NEW_DATA) == RCL_RET_OK;
  }
};
struct Battery : Entity {
  rcl_publisher_t publisher;
  bool begin(rcl_node_t * node, rclc_executor_t * executor) override {
    return rclc_publisher_init_default(&publisher, node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Float32), "battery") == RCL_RET_OK;
  }
};
Lamp lamp; Battery battery;
Entity * entities[] = { &lamp, &battery };
rcl_node_t node; rclc_executor_t executor;
void setup() {
  check(rclc_node_init_default(&node, "house", "", &support));
  check(rclc_executor_init(&executor, &support.context, 1, &allocator));
  for (Entity * each : entities) each->begin(&node, &executor);
}
void loop() { rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10)); delay(10); }
