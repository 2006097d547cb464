// Arduino: entities are created when the agent answers, and destroyed when it is lost.
#define EXECUTE_EVERY_N_MS(MS, X) do { static volatile int64_t t = -1; if (uxr_millis() - t > MS) { X; t = uxr_millis(); } } while (0)
enum states { WAITING_AGENT, AGENT_AVAILABLE, AGENT_CONNECTED, AGENT_DISCONNECTED } state;

void timer_callback(rcl_timer_t * timer, int64_t last_call_time) {
  RCSOFTCHECK(rcl_publish(&publisher, &msg, NULL));
}

bool create_entities() {
  RCCHECK(rclc_node_init_default(&node, "reconnecting", "", &support));
  RCCHECK(rclc_publisher_init_best_effort(&publisher, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "alive"));
  RCCHECK(rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(1000), timer_callback));
  RCCHECK(rclc_executor_init(&executor, &support.context, 1, &allocator));
  RCCHECK(rclc_executor_add_timer(&executor, &timer));
  return true;
}

void setup() {
  Serial.begin(921600);
  set_microros_serial_transports(Serial);
  state = WAITING_AGENT;
}

void loop() {
  switch (state) {
    case WAITING_AGENT:
      EXECUTE_EVERY_N_MS(500, state = (RMW_RET_OK == rmw_uros_ping_agent(100, 1)) ? AGENT_AVAILABLE : WAITING_AGENT;);
      break;
    case AGENT_AVAILABLE:
      state = (true == create_entities()) ? AGENT_CONNECTED : WAITING_AGENT;
      break;
    case AGENT_CONNECTED:
      rclc_executor_spin_some(&executor, RCL_MS_TO_NS(100));
      break;
    default:
      break;
  }
}
