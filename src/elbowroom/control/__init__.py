"""When: the key-frame queue, the plan/play/reset loop, recording and exact replay."""
