class HardwareFault(BaseException):
    pass


def generate_launch_description():
    raise HardwareFault('one\ntwo')
# expected: raises_lines.launch.py:6: expected launch code that is understood here, found HardwareFault: one\ntwo
