#include <micro_ros_arduino.h>
void setup() {
  set_microros_wifi_transports("net", "key", "10.0.0.2", 8888);
  check(rclc_node_init_default(&node, "tuned", "", &support));
  rclc_parameter_options_t options = { .notify_changed_over_dds = false, .max_params = 4, .allow_undeclared_parameters = false, .low_mem_mode = true };
  check(rclc_parameter_server_init_with_option(&server, &node, &options));
  check(rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(10), on_timer));
  check(rclc_executor_init(&executor, &support.context, RCLC_EXECUTOR_PARAMETER_SERVER_HANDLES + 1, &allocator));
  check(rclc_executor_add_parameter_server(&executor, &server, on_parameter));
  check(rclc_executor_add_timer(&executor, &timer));
  check(rclc_add_parameter(&server, "gain", RCLC_PARAMETER_DOUBLE));
}
void loop() { delay(2); rclc_executor_spin_some(&executor, RCL_MS_TO_NS(1)); }
