#include <zephyr/kernel.h>
K_THREAD_STACK_DEFINE(sender_stack, 16384);
static void begin(void) {
  check(rclc_node_init_default(&node, "rover", "", &support));
  check(rclc_publisher_init_best_effort(&imu, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "imu"));
  check(rclc_publisher_init_best_effort(&gnss, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "gnss"));
}
/* Nothing calls it. */
int light_init(void) {
  check(rclc_publisher_init_best_effort(&light, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Bool), "light"));
}
static void sender(void * a, void * b, void * c) {
  while (true) {
    if (k_poll(events, 2, K_FOREVER) != 0) { continue; }
    while (k_msgq_get(&imu_queue, &sample, K_NO_WAIT) == 0) { rcl_publish(&imu, &sample, NULL); }
    while (k_msgq_get(&gnss_queue, &fix, K_NO_WAIT) == 0) { rcl_publish(&gnss, &fix, NULL); }
  }
}
int main(void) {
  begin();
  k_thread_create(&thread, sender_stack, K_THREAD_STACK_SIZEOF(sender_stack), sender, NULL, NULL, NULL, K_PRIO_PREEMPT(2), 0, K_NO_WAIT);
}
