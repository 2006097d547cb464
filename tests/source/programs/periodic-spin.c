#include "hal_data.h"
void microros_entry(void * pvParameters) {
  check(rclc_node_init_default(&node, "ra6", "", &support));
  check(rclc_timer_init_default(&control, &support, RCL_MS_TO_NS(20), on_control));
  check(rclc_executor_init(&executor, &support.context, 1, &allocator));
  check(rclc_executor_set_timeout(&executor, RCL_MS_TO_NS(5)));
  check(rclc_executor_add_timer(&executor, &control));
  rclc_executor_spin_period(&executor, RCL_MS_TO_NS(20));
}
