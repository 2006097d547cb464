// Answers pings, and sends one every two seconds: two subscriptions, a timer, and publishers in callbacks.
#include <rcl/rcl.h>
#include <rclc/rclc.h>
#include <rclc/executor.h>
#include <std_msgs/msg/header.h>
#include <freertos/FreeRTOS.h>

#define CHECK(call) { if ((call) != RCL_RET_OK) { vTaskDelete(NULL); } }
#define PERIOD_MS (2 * 1000)

static rcl_publisher_t ping_publisher, pong_publisher;
static rcl_subscription_t ping_subscription, pong_subscription;
static rcl_timer_t ping_timer;
static std_msgs__msg__Header outgoing, ping, pong;

static void send_ping(void)
{
  CHECK(rcl_publish(&ping_publisher, &outgoing, NULL));
}

static void on_timer(rcl_timer_t * timer, int64_t last_call)
{
  send_ping();
}

static void on_ping(const void * message)
{
  CHECK(rcl_publish(&pong_publisher, message, NULL));
}

static void on_pong(const void * message)
{
}

static void micro_ros_task(void * argument)
{
  rcl_allocator_t allocator = rcl_get_default_allocator();
  rclc_support_t support;
  rcl_node_t node;
  rclc_executor_t executor = rclc_executor_get_zero_initialized_executor();
  CHECK(rclc_support_init(&support, 0, NULL, &allocator));
  CHECK(rclc_node_init_default(&node, "pingpong_node", "", &support));
  CHECK(rclc_publisher_init_default(&ping_publisher, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Header), "/ping"));
  CHECK(rclc_publisher_init_best_effort(&pong_publisher, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Header), "/pong"));
  CHECK(rclc_subscription_init_best_effort(&ping_subscription, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Header), "/ping"));
  CHECK(rclc_subscription_init_best_effort(&pong_subscription, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Header), "/pong"));
  CHECK(rclc_timer_init_default(&ping_timer, &support, RCL_MS_TO_NS(PERIOD_MS), on_timer));
  CHECK(rclc_executor_init(&executor, &support.context, 3, &allocator));
  CHECK(rclc_executor_add_timer(&executor, &ping_timer));
  CHECK(rclc_executor_add_subscription(&executor, &ping_subscription, &ping, &on_ping, ON_NEW_DATA));
  CHECK(rclc_executor_add_subscription(&executor, &pong_subscription, &pong, &on_pong, ON_NEW_DATA));
  while (1) {
    rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10));
    usleep(10000);
  }
}

void app_main(void)
{
  rmw_uros_set_custom_transport(true, NULL, uart_open, uart_close, uart_write, uart_read);
  xTaskCreate(micro_ros_task, "uros_task", 16000, NULL, 5, NULL);
}
