#include <micro_ros_platformio.h>
struct Slot { rcl_publisher_t publisher; const char * topic; };
Slot first, second;
std::vector<Slot *> slots;
struct Robot {
  void begin(const char * name, const char * password) { WiFi.begin(name, password); }
  void begin(HardwareSerial & line) { set_microros_serial_transports(Serial2); }
};
Robot robot;
void setup() {
  robot.begin(Serial2);
  slots.push_back(&first); slots.push_back(&second);
  check(rclc_node_init_default(&node, "list", "", &support));
  for (int i = 0; i < slots.size(); i++) {
    Slot * slot = slots[i];
    check(rclc_publisher_init_best_effort(&(slot->publisher), &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), slot->topic));
  }
  check(rclc_subscription_init_default(&go, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Bool), "go"));
  check(rclc_executor_init(&executor, &support.context, 1, &allocator));
  check(rclc_executor_add_subscription(&executor, &go, &message, on_go, ON_NEW_DATA));
}
void loop() { rclc_executor_spin_some(&executor, RCL_MS_TO_NS(5)); }
