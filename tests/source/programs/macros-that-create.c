#include <rcl/rcl.h>
#include <rclc/executor.h>
#define PUB_INIT(p, T, name) RCCHECK(rclc_publisher_init_default(&(p), &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, T), name))
rcl_publisher_t pa, pb;
int main() {
  RCCHECK(rclc_support_init(&support, 0, NULL, &allocator));
  RCCHECK(rclc_node_init_default(&node, "macros", "", &support));
  PUB_INIT(pa, Int32, "a");
  PUB_INIT(pb, Bool, "b");
  RCCHECK(rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(10), tcb));
  RCCHECK(rclc_executor_init(&executor, &support.context, 1, &allocator));
  RCCHECK(rclc_executor_add_timer(&executor, &timer));
  while (1) rclc_executor_spin_some(&executor, RCL_MS_TO_NS(1));
}
void tcb(rcl_timer_t *t, int64_t l) { rcl_publish(&pa, &a, NULL); rcl_publish(&pb, &b, NULL); }
