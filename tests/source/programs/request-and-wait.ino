#include <micro_ros_platformio.h>
void create_parameters() { check(rclc_parameter_server_init_default(&parameters, &node)); }
void setup() {
  set_microros_wifi_transports("net", "password", agent, 8888);
  while (rmw_uros_ping_agent(100, 1) != RMW_RET_OK) { delay(100); }
  check(rclc_node_init_default(&node, "beam", "", &support));
  check(rclc_client_init_default(&client, &node, ROSIDL_GET_SRV_TYPE_SUPPORT(std_srvs, srv, Trigger), "head"));
  check(rclc_executor_init(&executor, &support.context, RCLC_PARAMETER_EXECUTOR_HANDLES_NUMBER + 1, &allocator));
  check(rclc_executor_add_client(&executor, &client, &response, on_answer));
}
void loop() {
  answered = false;
  check(rcl_send_request(&client, &request, &number));
  while (!answered) {
    rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10));
    delay(10);
  }
}
