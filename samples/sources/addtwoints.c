// A service server and a client in one node.
#define NODE "calculator"
static void answer(const void * request, void * response) { add(request, response); }
static void on_response(const void * response) { show(response); }
static void on_timer(rcl_timer_t * timer, int64_t last) { int64_t sequence; CHECK(rcl_send_request(&client, &request, &sequence)); }

void appMain(void * argument)
{
  CHECK(rclc_node_init_default(&node, NODE, "", &support));
  CHECK(rclc_service_init_default(&service, &node, ROSIDL_GET_SRV_TYPE_SUPPORT(example_interfaces, srv, AddTwoInts), "/add"));
  CHECK(rclc_client_init_default(&client, &node, ROSIDL_GET_SRV_TYPE_SUPPORT(example_interfaces, srv, AddTwoInts), "/far/add"));
  CHECK(rclc_timer_init_default2(&timer, &support, RCL_S_TO_NS(1), on_timer, true));
  CHECK(rclc_executor_init(&executor, &support.context, 3, &allocator));
  CHECK(rclc_executor_add_service(&executor, &service, &req, &res, answer));
  CHECK(rclc_executor_add_client(&executor, &client, &res2, on_response));
  CHECK(rclc_executor_add_timer(&executor, &timer));
  for (;;) {
    rclc_executor_spin_some(&executor, RCL_MS_TO_NS(100));
    vTaskDelay(pdMS_TO_TICKS(10));
  }
}
