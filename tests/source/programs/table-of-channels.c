#include "pico/stdlib.h"
typedef struct { rcl_publisher_t publisher; const char * topic; } channel_t;
static channel_t channels[] = { { .topic = "range/left" }, { .topic = "range/right" }, { .topic = "range/front" } };
#define CHANNELS (sizeof(channels) / sizeof(channels[0]))
void on_timer(rcl_timer_t * timer, int64_t last) { for (size_t i = 0; i < CHANNELS; ++i) rcl_publish(&channels[i].publisher, &msg, NULL); }
int main(void) {
  check(rclc_node_init_default(&node, "ranges", "", &support));
  for (size_t i = 0; i < CHANNELS; ++i)
    check(rclc_publisher_init_best_effort(&channels[i].publisher, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Float32), channels[i].topic));
  check(rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(100), on_timer));
  check(rclc_executor_init(&executor, &support.context, 1, &allocator));
  check(rclc_executor_add_timer(&executor, &timer));
  while (true) rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10));
}
