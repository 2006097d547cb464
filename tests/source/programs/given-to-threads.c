#include <FreeRTOS.h>
#include <task.h>
#include "hal_data.h"
SemaphoreHandle_t mutex; rclc_support_t support;
void odom_thread(void * args) {
  rcl_publisher_t * out = (rcl_publisher_t *) args;
  for (;;) {
    xSemaphoreTake(mutex, portMAX_DELAY);
    rcl_publish(out, &msg, NULL);
    xSemaphoreGive(mutex);
    vTaskDelay(50 * configTICK_RATE_HZ / 1000);
  }
}
void on_twist(const void * m) {}
void twist_thread(void * args) {
  rclc_executor_t executor;
  rcl_subscription_t * in = (rcl_subscription_t *) args;
  RCCHECK(rclc_executor_init(&executor, &support.context, 1, &allocator));
  RCCHECK(rclc_executor_add_subscription(&executor, in, &twist, &on_twist, ON_NEW_DATA));
  while (1) {
    xSemaphoreTake(mutex, portMAX_DELAY);
    rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10));
    xSemaphoreGive(mutex);
    vTaskDelay(pdMS_TO_TICKS(10));
  }
}
void microros_app(void) {
  mutex = xSemaphoreCreateMutex();
  RCCHECK(rclc_support_init(&support, 0, NULL, &allocator));
  rcl_node_t node;
  RCCHECK(rclc_node_init_default(&node, "threads", "", &support));
  rcl_publisher_t odom_pub;
  RCCHECK(rclc_publisher_init_default(&odom_pub, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(geometry_msgs, msg, Pose), "odom"));
  rcl_subscription_t twist_sub;
  RCCHECK(rclc_subscription_init_default(&twist_sub, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(geometry_msgs, msg, Twist), "cmd_vel"));
  xTaskCreate(odom_thread, "odom", 1024, (void *) &odom_pub, 1, NULL);
  xTaskCreate(twist_thread, "twist", 2048, (void *) &twist_sub, 2, NULL);
}
