#include <pico/stdlib.h>
static rcl_timer_t * every(rclc_executor_t * executor, unsigned milliseconds, rcl_timer_callback_t callback) {
  rcl_timer_t * timer = malloc(sizeof(rcl_timer_t));
  check(rclc_timer_init_default(timer, &support, RCL_MS_TO_NS(milliseconds), callback));
  check(rclc_executor_add_timer(executor, timer));
  return timer;
}
int main(void) {
  rclc_executor_t executor;
  check(rclc_node_init_default(&node, "base", "", &support));
  check(rclc_executor_init(&executor, &support.context, 3, &allocator));
  every(&executor, 500, on_report);
  every(&executor, 200, on_watchdog);
  rcl_timer_t * returned = create();
  check(rclc_executor_add_timer(&executor, returned));
  rclc_executor_spin(&executor);
}
rcl_timer_t * create(void) {
  static rcl_timer_t timer;
  check(rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(50), on_control));
  return &timer;
}
