"""Programs that are combined from what people write, with what is true of them: a port, a style, and a loop.

What is expected follows from the parts that a program is made of; nothing of the package has a part in it.
"""

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

NOTHING = MappingProxyType({})


class PortParts(NamedTuple):
    """How programs of a port begin, how they wait 5 ms, and what that is.

    `body` has the places of the definitions, of what is done once, and of what is done again and again.
    """

    name: str
    head: str
    body: str
    wait: str
    item: str
    files: Mapping = NOTHING
    rtos: str = ""


MAIN = "{types}\n{entry}(void) {{\n{once}\n  while (1) {{\n{again}\n  }}\n}}\n"
ARDUINO = "{types}\nvoid setup() {{\n  set_microros_transports();\n{once}\n}}\nvoid loop() {{\n{again}\n}}\n"
WIFI = ARDUINO.replace("set_microros_transports()", 'set_microros_wifi_transports("net", "key", "10.0.0.2", 8888)')
TASK = "{types}\nvoid micro_ros_task(void * arg) {{\n{once}\n  for (;;) {{\n{again}\n  }}\n}}\n"
IDF = TASK + 'void app_main(void) {{ xTaskCreate(micro_ros_task, "uros_task", 16000, NULL, 5, NULL); }}\n'
CMSIS = TASK + (
    'const osThreadAttr_t attributes = {{ .name = "uros_task", .stack_size = 12000, .priority = (osPriority_t) osPriorityNormal }};\n'
    "int main(void) {{ osKernelInitialize(); osThreadNew(micro_ros_task, NULL, &attributes); osKernelStart(); }}\n"
)
FREERTOS = TASK + 'int main(void) {{ xTaskCreate(micro_ros_task, "uros_task", 3000, NULL, 3, NULL); vTaskStartScheduler(); }}\n'
TICKS = {"FreeRTOSConfig.h": "#define configTICK_RATE_HZ ((TickType_t) 1000)\n"}


def _main(entry):
    return MAIN.replace("{entry}", entry)


PORTS = (
    PortParts("arduino", "#include <micro_ros_arduino.h>\n", ARDUINO, "delay(5);", "busy_wait: 5 ms"),
    PortParts("arduino", "#include <micro_ros_arduino.h>\n", WIFI, "delay(5);", "sleep: 5 ms", rtos="freertos"),
    PortParts(
        *("platformio", "#include <Arduino.h>\n#include <micro_ros_platformio.h>\n", ARDUINO, "delay(5);", "sleep: 5 ms"),
        files={"platformio.ini": "[env:a]\nboard = esp32dev\nframework = arduino\nboard_microros_distro = jazzy\n"},
        rtos="freertos",
    ),
    PortParts(
        *("platformio", "#include <Arduino.h>\n#include <micro_ros_platformio.h>\n", ARDUINO, "delay(5);", "busy_wait: 5 ms"),
        files={"platformio.ini": "[env:a]\nboard = teensy41\nframework = arduino\nboard_microros_distro = humble\n"},
    ),
    PortParts(
        *(
            "espidf",
            '#include "freertos/FreeRTOS.h"\n#include "esp_log.h"\n',
            IDF,
            "vTaskDelay(pdMS_TO_TICKS(5));",
            "sleep: 5 ms",
        ),
        files={"sdkconfig": "CONFIG_FREERTOS_HZ=1000\n"},
        rtos="freertos",
    ),
    PortParts(
        *("espidf", '#include "freertos/FreeRTOS.h"\n#include "esp_log.h"\n', IDF, "usleep(5000);", "busy_wait: 5 ms"),
        files={"sdkconfig": "CONFIG_FREERTOS_HZ=100\n"},
        rtos="freertos",
    ),
    PortParts("zephyr", "#include <zephyr/kernel.h>\n", _main("void main"), "k_msleep(5);", "sleep: 5 ms", rtos="zephyr"),
    PortParts("zephyr", "#include <zephyr.h>\n", _main("void main"), "k_sleep(K_MSEC(5));", "sleep: 5 ms", rtos="zephyr"),
    PortParts("cubemx", '#include "cmsis_os.h"\n', CMSIS, "osDelay(5);", "sleep: 5 ms", TICKS, "freertos"),
    PortParts("cubemx", '#include "stm32f7xx_hal.h"\n', _main("int main"), "HAL_Delay(5);", "busy_wait: 5 ms"),
    PortParts("pico-sdk", '#include "pico/stdlib.h"\n', _main("int main"), "sleep_ms(5);", "sleep: 5 ms"),
    PortParts("renesas", '#include "hal_data.h"\n', _main("void hal_entry"), "usleep(5000);", "sleep: 5 ms"),
    PortParts("nuttx", "#include <nuttx/config.h>\n", _main("int main"), "usleep(5000);", "sleep: 5 ms", rtos="nuttx"),
    PortParts(
        "freertos", '#include "FreeRTOS.h"\n', FREERTOS, "vTaskDelay(5 / portTICK_PERIOD_MS);", "sleep: 5 ms", TICKS, "freertos"
    ),
)

INT32, TWIST = "ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32)", "ROSIDL_GET_MSG_TYPE_SUPPORT(geometry_msgs, msg, Twist)"
SET_BOOL = "ROSIDL_GET_SRV_TYPE_SUPPORT(std_srvs, srv, SetBool)"
CALLBACKS = """
void on_timer(rcl_timer_t * timer, int64_t last) { RCSOFTCHECK(rcl_publish(PUB, &msg, NULL)); }
void on_cmd(const void * message) { led = 1; }
void on_service(const void * request, void * response) { }
"""
MEMBERS = (
    "rcl_node_t node; rcl_publisher_t pub; rcl_subscription_t sub; rcl_timer_t timer; rcl_service_t service;\n"
    "rclc_support_t support; rclc_executor_t executor; rcl_allocator_t allocator; rclc_executor_t other;"
    " rclc_parameter_server_t params;"
)


def creations(holder="", **names):
    """What creates a node, a publisher, a subscription, a timer and a service, with variables in a holder."""
    texts = {"pub": '"wheel/speed"', "sub": '"cmd_vel"', "period": "RCL_MS_TO_NS(50)", "handles": "9"} | names
    node, pub, sub, timer, service, support, executor = (
        f"&{holder}{each}" for each in ("node", "pub", "sub", "timer", "service", "support", "executor")
    )
    if "get_node" in texts:
        node = texts["get_node"]
    return f"""  RCCHECK(rclc_support_init({support}, 0, NULL, &{holder}allocator));
  RCCHECK(rclc_node_init_default({node}, "robot", "", {support}));
  RCCHECK(rclc_publisher_init_best_effort({pub}, {node}, {INT32}, {texts["pub"]}));
  RCCHECK(rclc_subscription_init_default({sub}, {node}, {TWIST}, {texts["sub"]}));
  RCCHECK(rclc_timer_init_default({timer}, {support}, {texts["period"]}, on_timer));
  RCCHECK(rclc_service_init_default({service}, {node}, {SET_BOOL}, "enable"));
  RCCHECK(rclc_executor_init({executor}, {support}->context, {texts["handles"]}, &{holder}allocator));
  RCCHECK(rclc_executor_add_timer({executor}, {timer}));
  RCCHECK(rclc_executor_add_subscription({executor}, {sub}, &twist, &on_cmd, ON_NEW_DATA));
  RCCHECK(rclc_executor_add_service({executor}, {service}, &request, &response, on_service));"""


#: Of each program, unless its style says otherwise: topics with bytes of messages and reliability, periods in ms.
ENTITIES = {
    "publishers": {("wheel/speed", 4, "best-effort")},
    "subscriptions": {("cmd_vel", 48, "reliable")},
    "timers": {("on_timer", 50)},
    "services": {"on_service"},
}


class StyleParts(NamedTuple):
    """How a program holds its variables: definitions, what is done once, and the expression of an executor."""

    name: str
    types: str
    once: str
    executor: str = "&executor"
    publisher: str = "&pub"
    other: Mapping = NOTHING


def _style(name, types, once, executor="&executor", publisher="&pub", **other):
    return StyleParts(name, types + "\n" + CALLBACKS.replace("PUB", publisher), once, executor, publisher, other)


CLASS = f"""class Robot {{
public:
  {MEMBERS}
  bool begin();
  rcl_node_t * get_node() {{ return &node; }}
  rclc_executor_t * get_executor() {{ return &executor; }}
}};
Robot robot;"""
HELPERS = f"""{MEMBERS}
static bool advertise(rcl_publisher_t * p, const char * topic) {{
  return rclc_publisher_init_best_effort(p, &node, {INT32}, topic) == RCL_RET_OK;
}}
static bool listen(rcl_subscription_t * s, const char * topic, rclc_subscription_callback_t callback) {{
  if (rclc_subscription_init_default(s, &node, {TWIST}, topic) != RCL_RET_OK) return false;
  return rclc_executor_add_subscription(&executor, s, &twist, callback, ON_NEW_DATA) == RCL_RET_OK;
}}"""


def _without(text, *words):
    return "\n".join(line for line in text.splitlines() if not any(word in line for word in words))


ARRAYS = f"""enum Wheel {{ LEFT, RIGHT, WHEELS }};
{MEMBERS.replace("rcl_publisher_t pub;", "rcl_publisher_t pub[WHEELS];")}
const char * const topics[WHEELS] = {{ "left/speed", "right/speed" }};"""
LOOP_OVER_WHEELS = f"""  for (int i = 0; i < WHEELS; i++) {{
    RCCHECK(rclc_publisher_init_best_effort(&pub[i], &node, {INT32}, topics[i]));
  }}"""

STYLES = (
    _style("globals", MEMBERS, creations()),
    _style("struct", f"static struct {{\n{MEMBERS}\n}} app;", creations("app."), "&app.executor", "&app.pub"),
    _style(
        "pointer",
        f"struct App {{\n{MEMBERS}\n}};\nstatic struct App own;\nstatic struct App * const app = &own;",
        creations("app->"),
        "&app->executor",
        "&app->pub",
    ),
    _style("class", CLASS, creations("robot."), "&robot.executor", "&robot.pub"),
    _style("getters", CLASS, creations("robot.", get_node="robot.get_node()"), "robot.get_executor()", "&robot.pub"),
    _style(
        "macros",
        '#define TOPIC_PREFIX "wheel"\n#define SPEED_TOPIC TOPIC_PREFIX "/speed"\n#define RATE_HZ 20\n'
        "#define PERIOD_MS (1000 / RATE_HZ)\n"
        f"#define HANDLES (1 + 1 + 1 + 6)\n{MEMBERS}",
        creations(pub="SPEED_TOPIC", period="RCL_MS_TO_NS(PERIOD_MS)", handles="HANDLES"),
    ),
    _style(
        "constants",
        f'static const char SPEED_TOPIC[] = "wheel/speed";\nconst unsigned int PERIOD_MS = 50;\nenum {{ HANDLES = 9 }};\n{MEMBERS}',
        creations(pub="SPEED_TOPIC", period="RCL_MS_TO_NS(PERIOD_MS)", handles="HANDLES"),
    ),
    _style(
        "helpers",
        HELPERS,
        _without(creations(), "publisher_init", "subscription_init", "add_subscription").replace(
            "  RCCHECK(rclc_executor_add_service",
            '  advertise(&pub, "wheel/speed");\n  listen(&sub, "cmd_vel", on_cmd);\n  RCCHECK(rclc_executor_add_service',
        ),
    ),
    _style(
        "arrays",
        ARRAYS,
        _without(creations(), "publisher_init") + "\n" + LOOP_OVER_WHEELS,
        publisher="&pub[LEFT]",
        publishers={("left/speed", 4, "best-effort"), ("right/speed", 4, "best-effort")},
    ),
)


class LoopParts(NamedTuple):
    """What is done again and again, and what of it a description has, with `WAIT` for the wait of the port."""

    name: str
    text: str
    items: tuple
    once: str = ""
    other: Mapping = NOTHING


SPIN = "    RCSOFTCHECK(rclc_executor_spin_some(EXECUTOR, RCL_MS_TO_NS(10)));"
LOOPS = (
    LoopParts("plain", f"{SPIN}\n    WAIT", ("spin_some: 10 ms", "WAIT")),
    LoopParts("wait first", f"    WAIT\n{SPIN}", ("WAIT", "spin_some: 10 ms")),
    LoopParts(
        "ping",
        f"    if (RMW_RET_OK != rmw_uros_ping_agent(50, 3)) {{ connected = false; }}\n{SPIN}\n    WAIT",
        ("{ping: 150 ms, attempts: 3}", "spin_some: 10 ms", "WAIT"),
    ),
    LoopParts("sync", f"{SPIN}\n    rmw_uros_sync_session(1000);\n    WAIT", ("spin_some: 10 ms", "sync: 1 s", "WAIT")),
    LoopParts(
        "publish",
        f"{SPIN}\n    if (now() - last > 100) {{ last = now(); RCSOFTCHECK(rcl_publish(PUB, &msg, NULL)); }}\n    WAIT",
        ("spin_some: 10 ms", "publish: [TOPIC]", "WAIT"),
    ),
    LoopParts(
        "machine",
        "    switch (state) {\n    case WAITING: if (RMW_RET_OK == rmw_uros_ping_agent(100, 1)) state = CONNECTED; break;\n"
        f"    case CONNECTED:\n{SPIN}\n      break;\n    case DISCONNECTED: state = WAITING; break;\n"
        "    default: break;\n    }\n    WAIT",
        ("spin_some: 10 ms", "WAIT"),
    ),
    LoopParts(
        "reconnect",
        f"    if (!connected) {{ connected = rmw_uros_ping_agent(100, 1) == RMW_RET_OK; retry(); }}\n"
        f"    else {{\n{SPIN}\n    }}\n    WAIT",
        ("spin_some: 10 ms", "WAIT"),
    ),
    LoopParts(
        "two executors",
        f"{SPIN}\n    RCSOFTCHECK(rclc_executor_spin_some(&other, RCL_MS_TO_NS(20)));\n    WAIT",
        ("spin_some: 10 ms", "{spin_some: 20 ms, executor: other}", "WAIT"),
        "  RCCHECK(rclc_executor_init(&other, &support.context, 1, &allocator));\n"
        f'  RCCHECK(rclc_subscription_init_best_effort(&stop, NODE, {INT32}, "stop"));\n'
        "  RCCHECK(rclc_executor_add_subscription(&other, &stop, &number, &on_stop, ON_NEW_DATA));",
        {"subscriptions": {("stop", 4, "best-effort")}},
    ),
    LoopParts(
        "parameters",
        f"{SPIN}\n    WAIT",
        ("spin_some: 10 ms", "WAIT"),
        "  RCCHECK(rclc_parameter_server_init_default(&params, NODE));\n"
        "  RCCHECK(rclc_executor_add_parameter_server(EXECUTOR, &params, NULL));",
        {"parameters": True},
    ),
)


class Program(NamedTuple):
    """A program: its files, and what is true of it."""

    name: str
    files: dict
    port: str
    rtos: str
    loop: list
    entities: dict


#: Enough of everything, wherever a port takes it from.
_POOLS = ("NODES", "PUBLISHERS", "SUBSCRIPTIONS", "SERVICES", "CLIENTS", "HISTORY")
META = ", ".join(f'"-DRMW_UXRCE_MAX_{name}=20"' for name in _POOLS)
CONF = "".join(
    f"CONFIG_MICROROS_{name}=20\n" for name in ("NODES", "PUBLISHERS", "SUBSCRIBERS", "SERVERS", "CLIENTS", "RMW_HISTORIC")
)
ENOUGH = {"colcon.meta": f'{{"names": {{"rmw_microxrcedds": {{"cmake-args": [{META}]}}}}}}'}


def _program(number):
    port, style, loop = PORTS[number % len(PORTS)], STYLES[number % len(STYLES)], LOOPS[number // 3 % len(LOOPS)]
    node = "robot.get_node()" if style.name == "getters" else style.executor.replace("executor", "node")
    topic = sorted(style.other.get("publishers", ENTITIES["publishers"]))[0][0]

    def completed(text):
        text = text.replace("EXECUTOR", style.executor).replace("PUB", style.publisher).replace("NODE", node)
        return text.replace("    WAIT", f"    {port.wait}")

    once = style.once + ("\n" + completed(loop.once) if loop.once else "")
    text = port.head + port.body.format(types=style.types, once=once, again=completed(loop.text))
    wait = port.item
    other = "uros_task_other" if TASK in port.body else "other"
    items = [wait if each == "WAIT" else each.replace("TOPIC", topic).replace("other", other) for each in loop.items]
    entities = {kind: set(values) for kind, values in (ENTITIES | style.other).items()}
    for kind, values in loop.other.items():
        entities[kind] = entities[kind] | values if isinstance(values, set) else values
    is_c = style.name in ("globals", "struct", "pointer", "macros") and not port.body.startswith(ARDUINO[:30])
    suffix = "ino" if port.name == "arduino" else "c" if is_c else "cpp"
    return Program(
        f"{number}: {port.name}, {style.name}, {loop.name}",
        {f"main.{suffix}": text, **port.files, **({"prj.conf": CONF} if port.name == "zephyr" else ENOUGH)},
        port.name,
        port.rtos,
        items,
        entities,
    )


#: Each port with each style, and each of them with several loops.
PROGRAMS = [_program(number) for number in range(63)]
