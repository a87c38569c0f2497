from launch import LaunchDescription
from launch.actions import PopEnvironment


def generate_launch_description():
    return LaunchDescription([PopEnvironment()])
# expected: pop_without_push.launch.py:6: expected a push before each pop, found none
