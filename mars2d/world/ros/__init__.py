"""ROS 2: a run publishes its clock, frames, odometry and scans, and takes commands."""
