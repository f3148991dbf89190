"""The walker's body, the people, the ground, and the IMU: what a simulation is made of."""
