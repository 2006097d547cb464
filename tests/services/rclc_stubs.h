/* Declarations with the parameters that those of ros2/rclc and ros2/rcl have, so that a compiler checks calls of them. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#define OPAQUE(name) typedef struct name { int content; } name
OPAQUE(rcl_allocator_t);
OPAQUE(rcl_context_t);
OPAQUE(rcl_node_t);
OPAQUE(rcl_publisher_t);
OPAQUE(rcl_subscription_t);
OPAQUE(rcl_timer_t);
OPAQUE(rcl_service_t);
OPAQUE(rcl_client_t);
OPAQUE(rcl_guard_condition_t);
OPAQUE(rcl_guard_condition_options_t);
OPAQUE(rclc_executor_t);
OPAQUE(rclc_executor_handle_t);
OPAQUE(rclc_parameter_server_t);
OPAQUE(rclc_parameter_options_t);
OPAQUE(rclc_action_server_t);
OPAQUE(rclc_action_client_t);
OPAQUE(rmw_context_t);
OPAQUE(rmw_publisher_allocation_t);
OPAQUE(Parameter);
OPAQUE(rosidl_message_type_support_t);
OPAQUE(rosidl_service_type_support_t);
OPAQUE(rosidl_action_type_support_t);
typedef struct rclc_action_goal_handle_t rclc_action_goal_handle_t;
typedef int rcl_ret_t;
typedef int rmw_ret_t;
typedef struct { rcl_context_t context; } rclc_support_t;
typedef struct { size_t max_string_capacity, max_ros2_type_sequence_capacity, max_basic_type_sequence_capacity; } micro_ros_utilities_memory_conf_t;
typedef enum { ON_NEW_DATA, ALWAYS } rclc_executor_handle_invocation_t;
typedef enum { RCLCPP_EXECUTOR, LET } rclc_executor_semantics_t;
enum { RCL_RET_OK, RCL_RET_ERROR, RCL_RET_BAD_ALLOC = 10, RCL_RET_ACTION_GOAL_ACCEPTED = 2100, RCL_RET_ACTION_GOAL_REJECTED };
enum { RMW_RET_OK };
typedef enum { GOAL_STATE_SUCCEEDED = 4, GOAL_STATE_CANCELED, GOAL_STATE_ABORTED } rcl_action_goal_state_t;
typedef void (* rcl_timer_callback_t)(rcl_timer_t *, int64_t);
typedef void (* rclc_subscription_callback_t)(const void *);
typedef void (* rclc_service_callback_t)(const void *, void *);
typedef void (* rclc_client_callback_t)(const void *);
typedef void (* rclc_gc_callback_t)(void);
typedef rcl_ret_t (* rclc_action_server_handle_goal_callback_t)(rclc_action_goal_handle_t *, void *);
typedef bool (* rclc_action_server_handle_cancel_callback_t)(rclc_action_goal_handle_t *, void *);
typedef void (* rclc_action_client_goal_callback_t)(rclc_action_goal_handle_t *, bool, void *);
typedef void (* rclc_action_client_feedback_callback_t)(rclc_action_goal_handle_t *, void *, void *);
typedef void (* rclc_action_client_result_callback_t)(rclc_action_goal_handle_t *, void *, void *);
typedef void (* rclc_action_client_cancel_callback_t)(rclc_action_goal_handle_t *, bool, void *);
typedef bool (* rclc_parameter_callback_t)(const Parameter *, const Parameter *, void *);
typedef bool (* rclc_executor_trigger_t)(rclc_executor_handle_t *, unsigned int, void *);

#ifdef __cplusplus
extern "C" {
#endif
rcl_allocator_t rcl_get_default_allocator(void);
rcl_ret_t rclc_support_init(rclc_support_t *, int, char const * const *, rcl_allocator_t *);
rcl_ret_t rclc_support_fini(rclc_support_t *);
rcl_ret_t rclc_node_init_default(rcl_node_t *, const char *, const char *, rclc_support_t *);
rcl_ret_t rcl_node_fini(rcl_node_t *);
rcl_ret_t rclc_publisher_init_default(rcl_publisher_t *, const rcl_node_t *, const rosidl_message_type_support_t *, const char *);
rcl_ret_t rclc_publisher_init_best_effort(rcl_publisher_t *, const rcl_node_t *, const rosidl_message_type_support_t *, const char *);
rcl_ret_t rcl_publisher_fini(rcl_publisher_t *, rcl_node_t *);
rcl_ret_t rclc_subscription_init_default(rcl_subscription_t *, rcl_node_t *, const rosidl_message_type_support_t *, const char *);
rcl_ret_t rclc_subscription_init_best_effort(rcl_subscription_t *, rcl_node_t *, const rosidl_message_type_support_t *, const char *);
rcl_ret_t rcl_subscription_fini(rcl_subscription_t *, rcl_node_t *);
rcl_ret_t rclc_service_init_default(rcl_service_t *, const rcl_node_t *, const rosidl_service_type_support_t *, const char *);
rcl_ret_t rclc_service_init_best_effort(rcl_service_t *, const rcl_node_t *, const rosidl_service_type_support_t *, const char *);
rcl_ret_t rcl_service_fini(rcl_service_t *, rcl_node_t *);
rcl_ret_t rclc_client_init_default(rcl_client_t *, const rcl_node_t *, const rosidl_service_type_support_t *, const char *);
rcl_ret_t rclc_client_init_best_effort(rcl_client_t *, const rcl_node_t *, const rosidl_service_type_support_t *, const char *);
rcl_ret_t rcl_client_fini(rcl_client_t *, rcl_node_t *);
rcl_ret_t rclc_timer_init_default(rcl_timer_t *, rclc_support_t *, const uint64_t, const rcl_timer_callback_t);
rcl_ret_t rcl_timer_fini(rcl_timer_t *);
rcl_guard_condition_t rcl_get_zero_initialized_guard_condition(void);
rcl_guard_condition_options_t rcl_guard_condition_get_default_options(void);
rcl_ret_t rcl_guard_condition_init(rcl_guard_condition_t *, rcl_context_t *, const rcl_guard_condition_options_t);
rcl_ret_t rcl_guard_condition_fini(rcl_guard_condition_t *);
rcl_ret_t rclc_parameter_server_init_default(rclc_parameter_server_t *, rcl_node_t *);
rcl_ret_t rclc_parameter_server_init_with_option(rclc_parameter_server_t *, rcl_node_t *, const rclc_parameter_options_t *);
rcl_ret_t rclc_parameter_server_fini(rclc_parameter_server_t *, rcl_node_t *);
rcl_ret_t rcl_publish(const rcl_publisher_t *, const void *, rmw_publisher_allocation_t *);
rcl_ret_t rcl_send_request(const rcl_client_t *, const void *, int64_t *);
rcl_ret_t rclc_executor_init(rclc_executor_t *, rcl_context_t *, const size_t, const rcl_allocator_t *);
rcl_ret_t rclc_executor_fini(rclc_executor_t *);
rcl_ret_t rclc_executor_set_timeout(rclc_executor_t *, const uint64_t);
rcl_ret_t rclc_executor_set_semantics(rclc_executor_t *, rclc_executor_semantics_t);
rcl_ret_t rclc_executor_set_trigger(rclc_executor_t *, rclc_executor_trigger_t, void *);
bool rclc_executor_trigger_all(rclc_executor_handle_t *, unsigned int, void *);
bool rclc_executor_trigger_one(rclc_executor_handle_t *, unsigned int, void *);
bool rclc_executor_trigger_always(rclc_executor_handle_t *, unsigned int, void *);
rcl_ret_t rclc_executor_add_subscription(rclc_executor_t *, rcl_subscription_t *, void *, rclc_subscription_callback_t, rclc_executor_handle_invocation_t);
rcl_ret_t rclc_executor_add_timer(rclc_executor_t *, rcl_timer_t *);
rcl_ret_t rclc_executor_add_service(rclc_executor_t *, rcl_service_t *, void *, void *, rclc_service_callback_t);
rcl_ret_t rclc_executor_add_client(rclc_executor_t *, rcl_client_t *, void *, rclc_client_callback_t);
rcl_ret_t rclc_executor_add_guard_condition(rclc_executor_t *, rcl_guard_condition_t *, rclc_gc_callback_t);
rcl_ret_t rclc_executor_add_parameter_server(rclc_executor_t *, rclc_parameter_server_t *, rclc_parameter_callback_t);
rcl_ret_t rclc_action_server_init_default(rclc_action_server_t *, rcl_node_t *, rclc_support_t *, const rosidl_action_type_support_t *, const char *);
rcl_ret_t rclc_action_server_fini(rclc_action_server_t *, rcl_node_t *);
rcl_ret_t rclc_executor_add_action_server(rclc_executor_t *, rclc_action_server_t *, size_t, void *, size_t, rclc_action_server_handle_goal_callback_t, rclc_action_server_handle_cancel_callback_t, void *);
rcl_ret_t rclc_action_client_init_default(rclc_action_client_t *, rcl_node_t *, const rosidl_action_type_support_t *, const char *);
rcl_ret_t rclc_action_client_fini(rclc_action_client_t *, rcl_node_t *);
rcl_ret_t rclc_action_send_goal_request(rclc_action_client_t *, void *, rclc_action_goal_handle_t **);
rcl_ret_t rclc_executor_add_action_client(rclc_executor_t *, rclc_action_client_t *, size_t, void *, void *, rclc_action_client_goal_callback_t, rclc_action_client_feedback_callback_t, rclc_action_client_result_callback_t, rclc_action_client_cancel_callback_t, void *);
rcl_ret_t rclc_executor_spin(rclc_executor_t *);
rcl_ret_t rclc_executor_spin_some(rclc_executor_t *, const uint64_t);
rcl_ret_t rclc_executor_spin_period(rclc_executor_t *, const uint64_t);
rmw_context_t * rcl_context_get_rmw_context(rcl_context_t *);
rmw_ret_t rmw_uros_set_context_entity_destroy_session_timeout(rmw_context_t *, int);
rmw_ret_t rmw_uros_ping_agent(const int, const uint8_t);
rmw_ret_t rmw_uros_sync_session(const int);
bool micro_ros_utilities_create_message_memory(const rosidl_message_type_support_t *, void *, const micro_ros_utilities_memory_conf_t);
const rosidl_message_type_support_t * message_support(void);
const rosidl_service_type_support_t * service_support(void);
const rosidl_action_type_support_t * action_support(void);

/* Of operating systems and ports. */
int xTaskCreate(void (*)(void *), const char * const, const uint32_t, void * const, unsigned long, void *);
void vTaskDelay(const uint32_t);
int32_t k_sleep(int64_t);
int usleep(unsigned);
void sleep_us(uint64_t);
void busy_wait_us(uint64_t);
void HAL_Delay(uint32_t);
void delay(uint32_t);
void delayMicroseconds(uint32_t);
void esp_rom_delay_us(uint32_t);
#ifdef __cplusplus
}
#endif
#define ROSIDL_GET_MSG_TYPE_SUPPORT(package, kind, name) message_support()
#define ROSIDL_GET_SRV_TYPE_SUPPORT(package, kind, name) service_support()
#define ROSIDL_GET_ACTION_TYPE_SUPPORT(package, name) action_support()
#define K_THREAD_DEFINE(name, size, entry, a, b, c, priority, options, delay) void (* name)(void *, void *, void *) = entry
#define K_USEC(us) ((int64_t) (us))
#define pdMS_TO_TICKS(ms) ((uint32_t) (ms))
#define RCL_MS_TO_NS(ms) ((ms) * 1000000LL)
