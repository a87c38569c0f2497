from launch import LaunchDescription, Substitution
from launch.actions import LogInfo


class Quit(Substitution):
    def perform(self, context):
        raise SystemExit(3)


def generate_launch_description():
    return LaunchDescription([LogInfo(msg=Quit())])
# expected: exits_in_a_substitution.launch.py:7: expected launch code that is understood here, found SystemExit: 3
