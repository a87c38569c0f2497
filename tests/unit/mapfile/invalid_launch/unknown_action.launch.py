from launch.actions import DanceAction
# expected: unknown_action.launch.py:1: expected launch code that is understood here, found ImportError: cannot import name 'DanceAction' from 'launch.actions' (unknown location)
