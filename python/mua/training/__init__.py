"""The parts that all trainings share: a resumable run of Adam, checkpoints, processes, threads and memory."""
