#include "FreeRTOS.h"
#include "queue.h"
void producer(void *a) { for (;;) { float v = read(); xQueueSend(q, &v, 0); vTaskDelay(pdMS_TO_TICKS(5)); } }
void uros_task(void *a) {
  rclc_support_init(&support, 0, NULL, &allocator);
  rclc_node_init_default(&node, "queue", "", &support);
  rclc_publisher_init_best_effort(&pub, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Float32), "value");
  rclc_subscription_init_best_effort(&sub, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Float32), "setpoint");
  rclc_executor_init(&executor, &support.context, 1, &allocator);
  rclc_executor_add_subscription(&executor, &sub, &s, on_s, ON_NEW_DATA);
  for (;;) {
    rclc_executor_spin_some(&executor, RCL_MS_TO_NS(1));
    while (xQueueReceive(q, &m.data, 0) == pdTRUE) { rcl_publish(&pub, &m, NULL); }
    if (xQueueReceive(q2, &x, pdMS_TO_TICKS(10))) { handle(); }
  }
}
int main(void) { xTaskCreate(producer, "prod", 512, NULL, 6, NULL); xTaskCreate(uros_task, "uros", 4096, NULL, osPriorityNormal, NULL); vTaskStartScheduler(); }
