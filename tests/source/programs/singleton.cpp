#include <micro_ros_platformio.h>
#include <array>
namespace config { constexpr uint32_t kPeriod = 50; constexpr const char *kNode = "bot"; inline constexpr size_t kMotors = 2; }
namespace ros {
class Node {
 public:
  static Node &instance() { static Node n; return n; }
  bool init();
  void spin(uint32_t ms) { rclc_executor_spin_some(&executor_, RCL_MS_TO_NS(ms)); }
  rcl_publisher_t state_;
 private:
  Node() = default;
  rclc_support_t support_{}; rcl_node_t node_{}; rclc_executor_t executor_{}; rcl_timer_t timer_{};
  std::array<rcl_publisher_t, config::kMotors> motors_;
  std_msgs__msg__Int32 msg_{};
};
static void on_timer(rcl_timer_t *, int64_t) { rcl_publish(&Node::instance().state_, &m, nullptr); }
bool Node::init() {
  auto allocator = rcl_get_default_allocator();
  if (rclc_support_init(&support_, 0, nullptr, &allocator) != RCL_RET_OK) return false;
  if (rclc_node_init_default(&node_, config::kNode, "", &support_) != RCL_RET_OK) return false;
  if (rclc_publisher_init_default(&state_, &node_, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "state") != RCL_RET_OK) return false;
  for (size_t i = 0; i < motors_.size(); ++i) {
    char name[32];
    std::snprintf(name, sizeof(name), "motor_%zu/rpm", i);
    if (rclc_publisher_init_best_effort(&motors_[i], &node_, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Float32), name) != RCL_RET_OK) return false;
  }
  if (rclc_timer_init_default(&timer_, &support_, RCL_MS_TO_NS(config::kPeriod), on_timer) != RCL_RET_OK) return false;
  if (rclc_executor_init(&executor_, &support_.context, 1, &allocator) != RCL_RET_OK) return false;
  return rclc_executor_add_timer(&executor_, &timer_) == RCL_RET_OK;
}
}
void setup() { Serial.begin(115200); set_microros_serial_transports(Serial); ros::Node::instance().init(); }
void loop() { ros::Node::instance().spin(10); delay(2); }
