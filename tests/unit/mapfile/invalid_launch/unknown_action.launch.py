from launch.actions import RegisterEventHandler
# expected: unknown_action.launch.py:1: expected launch code that is understood here, found ImportError: cannot import name 'RegisterEventHandler' from 'launch.actions' (unknown location)
