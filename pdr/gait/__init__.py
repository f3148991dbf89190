"""The strides of one foot from its IMU, and their statistics."""
