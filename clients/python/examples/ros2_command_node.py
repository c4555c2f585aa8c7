"""A ROS 2 node: speech in, questions and plans out.

    GPSR_TOKEN=… python ros2_command_node.py --ros-args -p url:=http://localhost:8000 -p world:=household

Topics: ``speech/text`` (std_msgs/String, what was recognised), ``speech/say`` (std_msgs/String, to be spoken) and
``command/plan`` (std_msgs/String, the JSON of a plan in primitives that is sure, or that somebody has agreed to).
"""

from __future__ import annotations

import os
import queue
import threading
from collections.abc import Callable

import rclpy
from command_desk import CommandDesk
from rclpy.node import Node
from rclpy.publisher import Publisher
from std_msgs.msg import String

from gpsr_client import Workbench


class CommandNode(Node):  # type: ignore[misc]
    """Asks the workbench in a thread of its own, so that no callback waits for the network."""

    def __init__(self) -> None:
        super().__init__("gpsr_command")
        url = self.declare_parameter("url", "http://localhost:8000").value
        world = self.declare_parameter("world", "household").value
        workbench = Workbench(url, world, os.environ["GPSR_TOKEN"])
        self._say = self.create_publisher(String, "speech/say", 10)
        self._plan = self.create_publisher(String, "command/plan", 10)
        self._heard: queue.Queue[str] = queue.Queue()
        self._desk = CommandDesk(workbench, self._publish(self._say), self._publish(self._plan))
        self.create_subscription(String, "speech/text", lambda text: self._heard.put(text.data), 10)
        threading.Thread(target=self._work, daemon=True).start()

    def _work(self) -> None:
        while True:
            self._desk.hear(self._heard.get())

    @staticmethod
    def _publish(publisher: Publisher) -> Callable[[str], None]:
        def publish(text: str) -> None:
            publisher.publish(String(data=text))

        return publish


def main() -> None:
    rclpy.init()
    node = CommandNode()
    try:
        rclpy.spin(node)
    finally:
        node.destroy_node()
        rclpy.shutdown()


if __name__ == "__main__":
    main()
