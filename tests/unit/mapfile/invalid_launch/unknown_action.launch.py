from launch import LaunchDescription
from launch.actions import DanceAction


def generate_launch_description():
    return LaunchDescription([DanceAction()])
# expected: unknown_action.launch.py:6: expected a name of launch that is supported here, found 'launch.actions.DanceAction'
