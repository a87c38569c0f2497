from launch import LaunchDescription


def generate_launch_description():
    return LaunchDescription(["talker"])
# expected: not_an_action.launch.py:5: expected a launch action, found str
