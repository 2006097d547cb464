#include "FreeRTOS.h"
#include "cmsis_os.h"
typedef enum { S_WAIT, S_CREATE, S_RUN, S_LOST } state_t;
static state_t step(state_t s) {
  if (s == S_WAIT) { return rmw_uros_ping_agent(500, 1) == RMW_RET_OK ? S_CREATE : S_WAIT; }
  if (s == S_CREATE) { return create() ? S_RUN : S_WAIT; }
  if (s == S_RUN) {
    rclc_executor_spin_some(&ex, RCL_MS_TO_NS(20));
    static int n; if (++n > 100) { n = 0; if (rmw_uros_ping_agent(100, 2) != RMW_RET_OK) return S_LOST; }
    return S_RUN;
  }
  destroy(); return S_WAIT;
}
bool create(void) {
  if (rclc_support_init(&support, 0, NULL, &a) != RCL_RET_OK) return false;
  if (rclc_node_init_default(&node, "fsm", "", &support) != RCL_RET_OK) return false;
  if (rclc_subscription_init_default(&sub, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "cmd") != RCL_RET_OK) return false;
  if (rclc_executor_init(&ex, &support.context, 1, &a) != RCL_RET_OK) return false;
  return rclc_executor_add_subscription(&ex, &sub, &m, cb, ON_NEW_DATA) == RCL_RET_OK;
}
void StartDefaultTask(void *arg) { state_t s = S_WAIT; for (;;) { s = step(s); osDelay(1); } }
