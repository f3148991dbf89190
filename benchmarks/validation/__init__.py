"""Walks, truth and real recordings held against what is known of people and sensors."""
