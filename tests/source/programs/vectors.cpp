#include <Arduino.h>
#include <micro_ros_platformio.h>
#include <vector>
int registered = 0;
std::vector<rcl_timer_t> timers;
void add(int period) {
  timers.emplace_back();
  check(rclc_timer_init_default(&timers.back(), &support, RCL_MS_TO_NS(period), on_timer));
  registered++;
}
void setup() {
  check(rclc_node_init_default(&node, "dynamic", "", &support));
  add(10); add(20);
  check(rclc_executor_init(&executor, &support.context, registered, &allocator));
  for (auto & each : timers) check(rclc_executor_add_timer(&executor, &each));
}
void loop() { rclc_executor_spin_some(&executor, RCL_MS_TO_NS(1)); delay(1); }
