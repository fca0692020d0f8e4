"""Courses in the model of a place: its furniture, and some more, moved at random beside a way that stays free."""
