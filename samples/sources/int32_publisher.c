// A timer that publishes a counter; the main thread of NuttX spins.
#include <rclc/executor.h>
#include <std_msgs/msg/int32.h>

rcl_publisher_t publisher;
std_msgs__msg__Int32 message;

void timer_callback(rcl_timer_t * timer, int64_t last_call_time)
{
  (void) last_call_time;
  if (timer != NULL) {
    rcl_publish(&publisher, &message, NULL);
    message.data++;
  }
}

int main(int argc, char * argv[])
{
  const unsigned int timer_period = 1000;
  rclc_support_init(&support, argc, argv, &allocator);
  rclc_node_init_default(&node, "counter", "", &support);
  rclc_publisher_init_default(&publisher, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "count");
  rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(timer_period), timer_callback);
  rclc_executor_init(&executor, &support.context, 1, &allocator);
  rclc_executor_add_timer(&executor, &timer);
  rclc_executor_spin(&executor);
}
