/* Zephyr: the main thread spins; the timeout of 100 ns is a mistake of templates. */
#include <zephyr/kernel.h>

static rclc_executor_t executor;

static void on_command(const void * message)
{
}

void micro_ros_thread(void * a, void * b, void * c)
{
	rmw_uros_set_custom_transport(MICRO_ROS_FRAMING_REQUIRED, &params, zephyr_serial_open, zephyr_serial_close, zephyr_serial_write, zephyr_serial_read);
	RCCHECK(rclc_node_init_default(&node, "drive", "", &support));
	RCCHECK(rclc_subscription_init(&subscription, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(geometry_msgs, msg, Twist), "cmd_vel", &rmw_qos_profile_sensor_data));
	RCCHECK(rclc_executor_init(&executor, &support.context, 1, &allocator));
	RCCHECK(rclc_executor_add_subscription(&executor, &subscription, &twist, &on_command, ON_NEW_DATA));
	while (1) {
		rclc_executor_spin_some(&executor, 100);
		k_sleep(K_MSEC(5));
	}
}

K_THREAD_DEFINE(micro_ros, 16 * 1024, micro_ros_thread, NULL, NULL, NULL, 3, 0, 0);
