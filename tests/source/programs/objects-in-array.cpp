#include <micro_ros_platformio.h>
class Motor { public:
  Motor(int pin, const char *cmd, const char *fb) : pin_(pin), cmd_(cmd), fb_(fb) {}
  void setup(rcl_node_t &node, rclc_executor_t &ex) {
    rclc_subscription_init_default(&sub_, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Float32), cmd_);
    rclc_publisher_init_best_effort(&pub_, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Float32), fb_);
    rclc_executor_add_subscription_with_context(&ex, &sub_, &msg_, &Motor::cb, this, ON_NEW_DATA);
  }
  void publish() { rcl_publish(&pub_, &msg_, NULL); }
  static void cb(const void *m, void *ctx) { static_cast<Motor *>(ctx)->publish(); }
 private: int pin_; const char *cmd_; const char *fb_; rcl_subscription_t sub_; rcl_publisher_t pub_; std_msgs__msg__Float32 msg_; };
Motor motors[] = { Motor(1, "left/cmd", "left/state"), Motor(2, "right/cmd", "right/state") };
void setup() {
  set_microros_serial_transports(Serial);
  rclc_support_init(&support, 0, NULL, &allocator);
  rclc_node_init_default(&node, "reg", "", &support);
  rclc_executor_init(&executor, &support.context, 2, &allocator);
  for (auto &m : motors) m.setup(node, executor);
}
void loop() { rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10)); }
