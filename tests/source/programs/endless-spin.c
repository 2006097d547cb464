#include <nuttx/config.h>
#define CHECK(fn) if ((fn) != RCL_RET_OK) { printf("failed\n"); return 1; }
int main(int argc, FAR char * argv[]) {
  rcl_node_t node; rcl_client_t client; rclc_executor_t executor;
  CHECK(rclc_node_init_default(&node, "nuttx", "", &support));
  CHECK(rclc_client_init_default(&client, &node, ROSIDL_GET_SRV_TYPE_SUPPORT(std_srvs, srv, SetBool), "light"));
  CHECK(rclc_executor_init(&executor, &support.context, 1, &allocator));
  CHECK(rclc_executor_add_client(&executor, &client, &response, on_light));
  CHECK(rcl_send_request(&client, &request, &sequence));
  rclc_executor_spin(&executor);
  return 0;
}
