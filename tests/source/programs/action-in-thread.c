#include <stdio.h>
#include <unistd.h>
#include <pthread.h>
#include "freertos/FreeRTOS.h"
#include <rclc_action/rclc_action.h>
#include <example_interfaces/action/fibonacci.h>
#include <rclc/executor.h>
void *work(void *args) {
  rclc_action_goal_handle_t *goal_handle = (rclc_action_goal_handle_t *)args;
  example_interfaces__action__Fibonacci_FeedbackMessage feedback;
  for (size_t i = 2; i < 10; i++) {
    rclc_action_publish_feedback(goal_handle, &feedback);
    usleep(500000);
  }
  example_interfaces__action__Fibonacci_GetResult_Response response = {0};
  rclc_action_send_result(goal_handle, GOAL_STATE_SUCCEEDED, &response);
  pthread_exit(NULL);
}
rcl_ret_t handle_goal(rclc_action_goal_handle_t *goal_handle, void *context) {
  pthread_t *worker = malloc(sizeof(pthread_t));
  pthread_create(worker, NULL, work, goal_handle);
  return RCL_RET_ACTION_GOAL_ACCEPTED;
}
bool handle_cancel(rclc_action_goal_handle_t *goal_handle, void *context) { return true; }
void appMain(void *argument) {
  rcl_allocator_t allocator = rcl_get_default_allocator();
  rclc_support_t support;
  RCCHECK(rclc_support_init(&support, 0, NULL, &allocator));
  rcl_node_t node;
  RCCHECK(rclc_node_init_default(&node, "counter", "", &support));
  rclc_action_server_t server;
  RCCHECK(rclc_action_server_init_default(&server, &node, &support, ROSIDL_GET_ACTION_TYPE_SUPPORT(example_interfaces, Fibonacci), "count"));
  rclc_executor_t executor;
  rclc_executor_init(&executor, &support.context, 1, &allocator);
  example_interfaces__action__Fibonacci_SendGoal_Request goals[10];
  RCCHECK(rclc_executor_add_action_server(&executor, &server, 10, goals, sizeof(example_interfaces__action__Fibonacci_SendGoal_Request), handle_goal, handle_cancel, (void *)&server));
  while (1) { rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10)); usleep(100000); }
}
