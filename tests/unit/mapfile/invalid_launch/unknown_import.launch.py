from launch import LaunchDescription
from launch.no_such_part import OnProcessExit
# expected: unknown_import.launch.py:2: expected launch code that is understood here, found ModuleNotFoundError: No module named 'launch.no_such_part'
