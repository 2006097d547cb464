#include <micro_ros_arduino.h>
SemaphoreHandle_t mtx;
void rosTask(void *p) {
  for (;;) {
    if (xSemaphoreTake(mtx, portMAX_DELAY)) { rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10)); xSemaphoreGive(mtx); }
    vTaskDelay(5 / portTICK_PERIOD_MS);
  }
}
void imuTask(void *p) {
  TickType_t last = xTaskGetTickCount();
  for (;;) {
    readImu();
    if (xSemaphoreTake(mtx, pdMS_TO_TICKS(50)) == pdTRUE) { rcl_publish(&imu_pub, &imu, NULL); xSemaphoreGive(mtx); }
    vTaskDelayUntil(&last, pdMS_TO_TICKS(10));
  }
}
void setup() {
  set_microros_transports();
  rclc_support_init(&support, 0, NULL, &allocator);
  rclc_node_init_default(&node, "dual", "", &support);
  rclc_publisher_init_best_effort(&imu_pub, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(geometry_msgs, msg, Vector3), "gyro");
  rclc_subscription_init_best_effort(&sub, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(geometry_msgs, msg, Twist), "cmd_vel");
  rclc_executor_init(&executor, &support.context, 1, &allocator);
  rclc_executor_add_subscription(&executor, &sub, &t, &on_t, ON_NEW_DATA);
  mtx = xSemaphoreCreateMutex();
  xTaskCreatePinnedToCore(rosTask, "ros", 8192, NULL, 2, NULL, 0);
  xTaskCreatePinnedToCore(imuTask, "imu", 4096, NULL, 3, NULL, 1);
}
void loop() { vTaskDelete(NULL); }
