"""What sessions share and clients have sent: scenes, avatars, clips, runs."""
