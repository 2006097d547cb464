#include <nuttx/config.h>
int main(void) {
  rcl_node_init(&node, "echo", "", &context, &options);
  rcl_publisher_options_t fast = rcl_publisher_get_default_options();
  fast.qos.reliability = RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT;
  rcl_publisher_init(&answer, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "answer", &fast);
  rcl_subscription_init(&question, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "question", &others);
  do {
    rcl_wait_set_clear(&set);
    rcl_wait_set_add_subscription(&set, &question, &index);
    rcl_wait(&set, RCL_MS_TO_NS(100));
    if (set.subscriptions[index]) {
      rcl_take(set.subscriptions[index], &message, NULL, NULL);
      rcl_publish(&answer, &message, NULL);
    }
    usleep(10000);
  } while (true);
}
