"""The commands."""

import os

# Threads of torch that wait for each other sleep instead of spinning: on a machine that does anything else beside a
# bake, spinning makes short parallel loops many times slower. Read once, when torch is loaded.
os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")
