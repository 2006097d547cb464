#if defined(ESP32)
#include <WiFi.h>
#endif
#include <micro_ros_arduino.h>
#define USE_IMU 1
#define USE_MAG 0
rcl_publisher_t imu_pub, mag_pub;
void imu_cb(rcl_timer_t *t, int64_t d) {
#if USE_IMU
  rcl_publish(&imu_pub, &imu, NULL);
#endif
#if USE_MAG
  rcl_publish(&mag_pub, &mag, NULL);
#endif
}
void setup() {
#ifdef USE_WIFI
  set_microros_wifi_transports("a", "b", "10.0.0.1", 8888);
#else
  set_microros_transports();
#endif
  rclc_support_init(&support, 0, NULL, &allocator);
  rclc_node_init_default(&node, "imu", "", &support);
#if USE_IMU
  rclc_publisher_init_default(&imu_pub, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(sensor_msgs, msg, Imu), "imu");
#endif
#if USE_MAG
  rclc_publisher_init_default(&mag_pub, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(sensor_msgs, msg, MagneticField), "mag");
#endif
  rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(1000 / 50), imu_cb);
  rclc_executor_init(&executor, &support.context, 1, &allocator);
  rclc_executor_add_timer(&executor, &timer);
}
void loop() {
  rclc_executor_spin_some(&executor, RCL_MS_TO_NS(1));
#if USE_MAG
  delay(50);
#else
  delay(2);
#endif
}
