// A parameter server, and a timer whose period depends on a parameter at run time.
static bool on_changed(const Parameter * old, const Parameter * new, void * context) { return true; }
static void control(rcl_timer_t * timer, int64_t last) { }

int main(void)
{
  rclc_parameter_options_t options = { .notify_changed_over_dds = false, .max_params = 4, .low_mem_mode = true };
  check(rclc_node_init_default(&node, "tuned", "", &support));
  check(rclc_parameter_server_init_with_option(&server, &node, &options));
  check(rclc_timer_init_default(&timer, &support, read_period(), control));
  check(rclc_executor_init(&executor, &support.context, RCLC_EXECUTOR_PARAMETER_SERVER_HANDLES + 1, &allocator));
  check(rclc_executor_add_parameter_server(&executor, &server, on_changed));
  check(rclc_executor_add_timer(&executor, &timer));
  check(rclc_executor_set_timeout(&executor, RCL_MS_TO_NS(5)));
  check(rclc_executor_spin_period(&executor, RCL_MS_TO_NS(10)));
}
