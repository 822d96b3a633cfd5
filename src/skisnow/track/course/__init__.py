"""Courses: gates, whether they were passed, and when."""

from __future__ import annotations

from .course import Course, Gate, course_names
from .course_file import on_slope, read_course
from .passages import CourseResult, MovingPoint, Passage, passages

__all__ = [
    "Course", "CourseResult", "Gate", "MovingPoint", "Passage", "course_names", "on_slope", "passages", "read_course",
]  # fmt: skip
