// Two executors of one class, each in a task of its own; timers in an array.
#include "freertos/FreeRTOS.h"

class Robot {
public:
  void create();
  static void sense(rcl_timer_t * timer, int64_t last) { instance->publish_state(); }
  static void on_command(const void * message) {}
  void spin_fast() { while (true) { rclc_executor_spin_some(&fast_, RCL_MS_TO_NS(1)); vTaskDelay(1); } }
  void spin_slow() { while (true) { rclc_executor_spin_some(&slow_, RCL_MS_TO_NS(50)); vTaskDelay(20 / portTICK_PERIOD_MS); } }
private:
  void publish_state() { check(rcl_publish(&state_, &message_, nullptr)); }
  static constexpr int kTimers = 2;
  rclc_executor_t fast_, slow_;
  rcl_publisher_t state_;
  rcl_subscription_t command_;
  rcl_timer_t timers_[2];
};

void Robot::create()
{
  check(rclc_node_init_default(&node_, "robot", "", &support_));
  check(rclc_publisher_init_best_effort(&state_, &node_, ROSIDL_GET_MSG_TYPE_SUPPORT(geometry_msgs, msg, Pose2D), "state"));
  check(rclc_subscription_init_default(&command_, &node_, ROSIDL_GET_MSG_TYPE_SUPPORT(geometry_msgs, msg, Twist), "cmd_vel"));
  check(rclc_executor_init(&fast_, &support_.context, 2, &allocator_));
  check(rclc_executor_init(&slow_, &support_.context, 1, &allocator_));
  for (int i = 0; i < 2; i++) {
    check(rclc_timer_init_default(&timers_[i], &support_, RCL_MS_TO_NS(10 * (i + 1)), sense));
    check(rclc_executor_add_timer(&fast_, &timers_[i]));
  }
  check(rclc_executor_add_subscription(&slow_, &command_, &twist_, &Robot::on_command, ON_NEW_DATA));
}

static Robot robot;
static void fast_task(void *) { robot.spin_fast(); }
static void slow_task(void *) { robot.spin_slow(); }

extern "C" void app_main()
{
  robot.create();
  xTaskCreatePinnedToCore(fast_task, "fast", 8192, NULL, 7, NULL, 0);
  xTaskCreatePinnedToCore(slow_task, "slow", 8192, NULL, 3, NULL, 1);
}
