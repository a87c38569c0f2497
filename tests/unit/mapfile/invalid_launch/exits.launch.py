import sys

sys.exit("no robot here")
# expected: exits.launch.py:3: expected launch code that is understood here, found SystemExit: no robot here
