#include "cmsis_os.h"
osThreadId defaultTaskHandle;
void StartDefaultTask(void const * argument) {
  check(rclc_node_init_default(&node, "cube", "", &support));
  check(rclc_publisher_init_best_effort(&pub, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "counter"));
  for (;;) {
    if (rcl_publish(&pub, &msg, NULL) != RCL_RET_OK) { printf("lost"); }
    osDelay(10);
  }
}
int main(void) {
  osThreadDef(defaultTask, StartDefaultTask, osPriorityNormal, 0, 3000);
  defaultTaskHandle = osThreadCreate(osThread(defaultTask), NULL);
  osKernelStart();
}
