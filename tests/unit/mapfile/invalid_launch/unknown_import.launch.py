from launch import LaunchDescription
from launch.event_handlers import OnProcessExit
# expected: unknown_import.launch.py:2: expected launch code that is understood here, found ModuleNotFoundError: No module named 'launch.event_handlers'
