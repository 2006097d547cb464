// Sensor fusion: LET semantics, and a trigger that waits for both inputs.
static void on_imu(const void * message) { }
static void on_odometry(const void * message) { }
static bool both(rclc_executor_handle_t * handles, unsigned int size, void * object) { return handles[0].data_available && handles[1].data_available; }

void main(void)
{
  check(rclc_node_init_default(&node, "fusion", "", &support));
  check(rclc_subscription_init_best_effort(&imu, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(sensor_msgs, msg, Imu), "imu"));
  check(rclc_subscription_init_best_effort(&odometry, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(nav_msgs, msg, Odometry), "odom"));
  check(rclc_executor_init(&fusion, &support.context, 2, &allocator));
  check(rclc_executor_add_subscription(&fusion, &imu, &imu_message, &on_imu, ALWAYS));
  check(rclc_executor_add_subscription(&fusion, &odometry, &odometry_message, &on_odometry, ON_NEW_DATA));
  check(rclc_executor_set_semantics(&fusion, LET));
  check(rclc_executor_set_trigger(&fusion, both, NULL));
  while (1) {
    check(rclc_executor_spin_some(&fusion, RCL_MS_TO_NS(20)));
    usleep(1000);
  }
}
