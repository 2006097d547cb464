#include <Arduino.h>
#include <micro_ros_arduino.h>
static rcl_node_t node; static rcl_timer_t odom_timer; static rclc_executor_t executor; static rcl_publisher_t odom;
static void on_odom(rcl_timer_t * timer, int64_t) { if (rcl_ret_t const rc = rcl_publish(&odom, &msg, nullptr); rc != RCL_RET_OK) log(rc); }
void setup() {
  if (rcl_ret_t const rc = rclc_node_init_default(&node, "alvik", "", &support); rc != RCL_RET_OK) error_loop(rc);
  if (rcl_ret_t const rc = rclc_publisher_init_default(&odom, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(geometry_msgs, msg, Pose2D), "odom"); rc != RCL_RET_OK) error_loop(rc);
  if (rcl_ret_t const rc = rclc_timer_init_default(&odom_timer, &support, RCL_MS_TO_NS(50), on_odom); rc != RCL_RET_OK) error_loop(rc);
  if (rcl_ret_t const rc = rclc_executor_init(&executor, &support.context, 2, &allocator); rc != RCL_RET_OK) error_loop(rc);
  if (rcl_ret_t const rc = rclc_executor_add_timer(&executor, &odom_timer); rc != RCL_RET_OK) error_loop(rc);
}
void loop() { rclc_executor_spin_some(&executor, RCL_MS_TO_NS(100)); }
