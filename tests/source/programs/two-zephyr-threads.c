#include <zephyr/kernel.h>
static rcl_node_t node; static rclc_executor_t executor; static rcl_subscription_t cmd; static rcl_publisher_t state;
static K_MUTEX_DEFINE(lock);
static void sensors(void * a, void * b, void * c) {
  while (1) {
    k_mutex_lock(&lock, K_FOREVER);
    check(rcl_publish(&state, &state_message, NULL));
    k_mutex_unlock(&lock);
    k_sleep(K_MSEC(50));
  }
}
static void ros(void * a, void * b, void * c) {
  check(rclc_node_init_default(&node, "zephyr", "", &support));
  check(rclc_publisher_init_best_effort(&state, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "state"));
  check(rclc_subscription_init_default(&cmd, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "cmd"));
  check(rclc_executor_init(&executor, &support.context, 1, &allocator));
  check(rclc_executor_add_subscription(&executor, &cmd, &cmd_message, &on_cmd, ON_NEW_DATA));
  while (1) { rclc_executor_spin_some(&executor, RCL_MS_TO_NS(5)); k_msleep(5); }
}
K_THREAD_DEFINE(ros_thread, 20000, ros, NULL, NULL, NULL, 5, 0, 0);
K_THREAD_DEFINE(sensor_thread, 16000, sensors, NULL, NULL, NULL, 6, 0, 0);
