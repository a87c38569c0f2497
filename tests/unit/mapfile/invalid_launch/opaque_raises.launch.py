from launch import LaunchDescription
from launch.actions import OpaqueFunction
from launch.substitutions import LaunchConfiguration


def setup(context):
    return [LaunchConfiguration("map").perform(context)]


def generate_launch_description():
    return LaunchDescription([OpaqueFunction(function=setup)])
# expected: opaque_raises.launch.py:7: expected a declared launch argument (none), found 'map'
