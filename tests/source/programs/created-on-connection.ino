#include <micro_ros_arduino.h>
#include <ESP32Servo.h>
bool connected = false;
void setup() { set_microros_serial_transports(Serial2); }
void synchronise() { check(rmw_uros_sync_session(1000)); delay(30); }
void create() {
  check(rclc_node_init_default(&node, "arm", "", &support));
  check(rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(50), on_timer));
  check(rclc_executor_init(&executor, &support.context, 1, &allocator));
  check(rclc_executor_add_timer(&executor, &timer));
  synchronise();
  connected = true;
}
void loop() {
  if (millis() - last > 100) {
    last = millis();
    if (rmw_uros_ping_agent(50, 2) == RMW_RET_OK) {
      if (!connected) { create(); }
    } else { destroy(); }
  }
  if (connected) { rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10)); }
}
