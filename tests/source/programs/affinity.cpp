#include <FreeRTOS.h>
constexpr etl::array<etl::string_view, 2> names{"left", "right"};
static etl::array<rcl_publisher_t, 2> wheels{};
static void run(void * given) {
  check(rclc_node_init_default(&node, "drive", "", &support));
  for (int i = 0; i < 2; i++) {
    check(rclc_publisher_init_best_effort(&wheels[i], &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), names[i].data()));
  }
  check(rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(100), on_timer));
  check(rclc_executor_init(&executor, &support.context, 1, &allocator));
  check(rclc_executor_add_timer(&executor, &timer));
  while (true) {
    rclc_executor_spin_some(&executor, RCL_MS_TO_NS(100));
    vTaskDelay(pdMS_TO_TICKS(50));
  }
}
int main() { xTaskCreateAffinitySet(run, "executor_task", 4000, nullptr, 4, 0x01, nullptr); }
