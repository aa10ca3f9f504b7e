"""What every training shares: a resumable run of Adam, checkpoints, processes, threads and memory."""
