import launch.no_such_part
from launch import LaunchDescription


class Mine(launch.no_such_part.dances.Dance):
    pass


def generate_launch_description():
    return LaunchDescription([])
# expected: unknown_import.launch.py:5: expected a name of launch that is supported here, found 'launch.no_such_part.dances.Dance'
