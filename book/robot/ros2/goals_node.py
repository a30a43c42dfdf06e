"""Who wants the robot to park: sets the node's parameters, sends goals, cancels them.

It reads a wish a line, as JSON, and writes what came of it.
"""

from __future__ import annotations

import json
import sys
import threading
from typing import Any

import rclpy
from lawn_node import set_yaw
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from wmr_interfaces.action import Park

PATIENT = 30.0  # s


class Goals:
    """A client of the action `park`."""

    def __init__(self) -> None:
        rclpy.init()
        self.node, self.executor = rclpy.create_node("goals"), SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.thread = threading.Thread(target=self.executor.spin)  # it hears every feedback
        self.thread.start()
        self.client = ActionClient(self.node, Park, "park")
        self.parameters = AsyncParameterClient(self.node, "wmr_park")
        self.handle: Any = None
        self.states: list[str] = []
        found = self.client.wait_for_server(PATIENT)
        if not found or not self.parameters.wait_for_services(PATIENT):
            raise RuntimeError("there is no node that parks")

    def wait(self, future: Any) -> Any:
        done = threading.Event()
        future.add_done_callback(lambda _: done.set())
        if not done.wait(PATIENT):
            raise RuntimeError("the node does not answer")
        return future.result()

    def set(self, values: dict[str, Any]) -> str:
        """Set parameters; why one was refused."""
        wanted = [Parameter(name, value=value) for name, value in values.items()]
        answer = self.wait(self.parameters.set_parameters(wanted))
        return "; ".join(each.reason for each in answer.results if not each.successful)

    def park(self, goal: list[float] | None) -> bool:
        """Send a goal; whether it was accepted."""
        asked, self.states = Park.Goal(), []
        if goal:
            asked.goal.header.frame_id = "map"
            asked.goal.pose.position.x, asked.goal.pose.position.y = goal[:2]
            set_yaw(asked.goal.pose.orientation, goal[2])
        self.handle = self.wait(self.client.send_goal_async(asked, self.hear))
        return self.handle.accepted

    def another(self, goal: list[float]) -> bool:
        """Send a goal beside the last one; whether it was accepted."""
        first, accepted = self.handle, self.park(goal)
        self.handle = first
        return accepted

    def hear(self, message: Any) -> None:
        if not self.states or self.states[-1] != message.feedback.state:
            self.states.append(message.feedback.state)

    def cancel(self) -> bool:
        """Cancel the last goal; whether the node does."""
        return bool(self.wait(self.handle.cancel_goal_async()).goals_canceling)

    def result(self) -> dict:
        """How the last goal ended: the action's status, and the node's words."""
        ended = self.wait(self.handle.get_result_async())
        words = {"state": ended.result.state, "reason": ended.result.reason}
        return words | {"status": ended.status, "states": self.states}


def main() -> None:
    """Answer the lines of standard input."""
    goals = Goals()
    for line in sys.stdin:
        name, *given = json.loads(line)
        print(json.dumps(getattr(goals, name)(*given)), flush=True)
    goals.executor.shutdown()
    goals.thread.join()


if __name__ == "__main__":
    main()
