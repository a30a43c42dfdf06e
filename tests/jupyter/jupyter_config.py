c.KernelManager.transport = "ipc"  # noqa: F821
