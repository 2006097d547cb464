#include "freertos/FreeRTOS.h"
class Arm {
 public:
  bool begin() {
    if (rclc_node_init_default(&node_, "arm", "", &support) != RCL_RET_OK) return false;
    if (rclc_publisher_init_best_effort(&state_, &node_, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Float32), "state") != RCL_RET_OK) return false;
    if (rclc_subscription_init_default(&goal_, &node_, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Float32), "goal") != RCL_RET_OK) return false;
    if (rclc_executor_init(&executor_, &support.context, 1, &allocator) != RCL_RET_OK) return false;
    return rclc_executor_add_subscription_with_context(&executor_, &goal_, &message_,
      [](const void * message, void * self) { static_cast<Arm *>(self)->on_goal(message); }, this, ON_NEW_DATA) == RCL_RET_OK;
  }
  void on_goal(const void * message) { (void) rcl_publish(&state_, &message_, nullptr); }
  [[noreturn]] void run() { for (;;) { (void) rclc_executor_spin_some(&executor_, RCL_MS_TO_NS(10)); vTaskDelay(pdMS_TO_TICKS(20)); } }
 private:
  rcl_node_t node_; rcl_publisher_t state_; rcl_subscription_t goal_; rclc_executor_t executor_; std_msgs__msg__Float32 message_;
};
static Arm arm;
extern "C" void app_main() {
  xTaskCreatePinnedToCore([](void *) { if (arm.begin()) arm.run(); }, "arm_task", 12000, nullptr, 6, nullptr, 1);
}
