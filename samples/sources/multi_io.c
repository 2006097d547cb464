// STM32 with CMSIS-RTOS2: timers and subscriptions mixed, and a publication beside the executor.
#define configTICK_RATE_HZ ((TickType_t) 1000)
const osThreadAttr_t task_attributes = { .name = "microros", .stack_size = 3000 * 4, .priority = (osPriority_t) osPriorityNormal };

static void fast(rcl_timer_t * timer, int64_t last) { }
static void slow(rcl_timer_t * timer, int64_t last) { check(rcl_publish(&text, &string_message, NULL)); }
static void left(const void * message) { }

void StartTask(void * argument)
{
  huart3.Init.BaudRate = 460800;
  rmw_uros_set_custom_transport(true, &huart3, cubemx_open, cubemx_close, cubemx_write, cubemx_read);
  check(rclc_node_init_default(&node, "io", "plant", &support));
  check(rclc_publisher_init_default(&text, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, String), "text"));
  check(rclc_publisher_init_best_effort(&raw, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(my_msgs, msg, Raw), "raw"));
  check(rclc_timer_init_default(&fast_timer, &support, RCL_US_TO_NS(500), fast));
  check(rclc_timer_init_default(&slow_timer, &support, 1000000000, slow));
  check(rclc_subscription_init_default(&left_subscription, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Float32), "left"));
  check(rclc_executor_init(&executor, &support.context, 2, &allocator));
  check(rclc_executor_add_subscription(&executor, &left_subscription, &float_message, left, ON_NEW_DATA));
  check(rclc_executor_add_timer(&executor, &fast_timer));
  check(rclc_executor_add_timer(&executor, &slow_timer));
  for (;;) {
    rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10));
    rcl_publish(&raw, &raw_message, NULL);
    osDelay(10);
  }
}

int main(void) { osThreadNew(StartTask, NULL, &task_attributes); osKernelStart(); }
