#include "pico/stdlib.h"
#include <array>
namespace ros {
inline std::array<rcl_publisher_t, 4> feedback{};
const std::array<const char *, 4> topics{"m/0", "m/1", "m/2", "m/3"};
rcl_ret_t create(rcl_node_t * node) {
  for (std::size_t i = 0; i < feedback.size(); i++) {
    rcl_ret_t rc = rclc_publisher_init_default(&feedback[i], node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Float32), topics[i]);
    if (rc != RCL_RET_OK) return rc;
  }
  return RCL_RET_OK;
}
}  // namespace ros
static void on_timer(rcl_timer_t * timer, int64_t last) { for (std::size_t i = 0; i < 4; i++) rcl_publish(&ros::feedback[i], &msg, nullptr); }
int main() {
  check(rclc_node_init_default(&node, "motors", "", &support));
  check(ros::create(&node));
  check(rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(20), on_timer));
  check(rclc_executor_init(&executor, &support.context, 1, &allocator));
  check(rclc_executor_add_timer(&executor, &timer));
  for (;;) { rclc_executor_spin_some(&executor, RCL_MS_TO_NS(1)); sleep_ms(4); }
}
