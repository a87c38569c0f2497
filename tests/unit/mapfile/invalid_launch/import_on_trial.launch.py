try:
    from launch.actions import DanceAction
except ImportError as error:
    raise SystemExit("no dance") from error
# expected: import_on_trial.launch.py:4: expected launch code that is understood here, found SystemExit: no dance
