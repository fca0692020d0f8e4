"""What the planners need of a body: its limbs, frames, legs, and which parts of it must keep apart."""
