#include <micro_ros_platformio.h>
#include <rclc/executor.h>
template <typename T> class Publisher {
 public:
  Publisher(const char *topic, const rosidl_message_type_support_t *ts) : topic_(topic), ts_(ts) {}
  void init(rcl_node_t *node) { rclc_publisher_init_default(&pub_, node, ts_, topic_); }
  void publish() { rcl_publish(&pub_, &msg, NULL); }
  T msg;
 private:
  rcl_publisher_t pub_; const char *topic_; const rosidl_message_type_support_t *ts_;
};
Publisher<std_msgs__msg__Float32> voltage("battery/voltage", ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Float32));
Publisher<std_msgs__msg__Int32> count("count", ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32));
rclc_executor_t executor; rcl_timer_t timer; rclc_support_t support; rcl_node_t node; rcl_allocator_t allocator;
void on_timer(rcl_timer_t *, int64_t) { voltage.publish(); count.publish(); }
void setup() {
  Serial.begin(115200); set_microros_serial_transports(Serial);
  allocator = rcl_get_default_allocator();
  rclc_support_init(&support, 0, NULL, &allocator);
  rclc_node_init_default(&node, "battery", "", &support);
  voltage.init(&node); count.init(&node);
  rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(100), on_timer);
  rclc_executor_init(&executor, &support.context, 1, &allocator);
  rclc_executor_add_timer(&executor, &timer);
}
void loop() { rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10)); delay(5); }
