#include <rcl/rcl.h>
#include <rclc/executor.h>
int main(int argc, const char *argv[]) {
  rcl_init_options_t options = rcl_get_zero_initialized_init_options();
  rcl_init_options_init(&options, rcl_get_default_allocator());
  rcl_context_t context = rcl_get_zero_initialized_context();
  rcl_init(argc, argv, &options, &context);
  rcl_node_t node = rcl_get_zero_initialized_node();
  rcl_node_options_t node_ops = rcl_node_get_default_options();
  rcl_node_init(&node, "raw", "", &context, &node_ops);
  rcl_publisher_t pub = rcl_get_zero_initialized_publisher();
  rcl_publisher_options_t po = rcl_publisher_get_default_options();
  rcl_publisher_init(&pub, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "raw_pub", &po);
  std_msgs__msg__Int32 msg; msg.data = 0;
  do { rcl_publish(&pub, (const void *)&msg, NULL); msg.data++; usleep(10000); } while (true);
}
