"""What an assembly works on: the controller, planned tasks, stimuli, execution demands, and the runnables of executors."""
