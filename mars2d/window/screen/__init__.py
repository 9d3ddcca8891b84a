"""What each window stands on: the display, its looks, the camera, what is under the pointer."""
