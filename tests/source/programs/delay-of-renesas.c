#include "microros_thread.h"
#include "hal_data.h"
#include <rcl/rcl.h>
#include <rclc/rclc.h>
#include <rclc/executor.h>
#include <std_msgs/msg/int64.h>
#include <microros_transports.h>
rcl_publisher_t ping_pub; rcl_subscription_t pong_sub; std_msgs__msg__Int64 ping; std_msgs__msg__Int64 pong;
void pong_cb(const void * msgin) { (void)msgin; }
void ros_thread(void *argument)
{
    custom_transport_args agent = { .agent_ip_address = "192.168.1.3", .agent_port=8888 };
    rmw_uros_set_custom_transport(false, (void *) &agent, renesas_e2_transport_open, renesas_e2_transport_close, renesas_e2_transport_write, renesas_e2_transport_read);
    rcl_allocator_t allocator = rcl_get_default_allocator();
    rclc_support_t support;
    rclc_support_init(&support, 0, NULL, &allocator);
    rcl_node_t node;
    rclc_node_init_default(&node, "renesas_node", "", &support);
    rclc_publisher_init_best_effort(&ping_pub, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int64), "ping");
    rclc_subscription_init_best_effort(&pong_sub, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int64), "pong");
    rclc_executor_t executor = rclc_executor_get_zero_initialized_executor();
    rclc_executor_init(&executor, &support.context, 1, &allocator);
    rclc_executor_add_subscription(&executor, &pong_sub, &pong, &pong_cb, ON_NEW_DATA);
    while(1)
    {
        ping.data++;
        rcl_publish(&ping_pub, &ping, NULL);
        rclc_executor_spin_some(&executor, RCL_MS_TO_NS(1000));
        R_BSP_SoftwareDelay(100, BSP_DELAY_UNITS_MILLISECONDS);
    }
}
