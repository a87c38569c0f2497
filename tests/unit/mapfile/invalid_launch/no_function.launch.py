from launch import LaunchDescription
# expected: no_function.launch.py: expected a function generate_launch_description, found none
