"""Courses: gates, whether they were passed, and when."""

from __future__ import annotations

from .course import Course, Discipline, Gate, course_names
from .course_file import course_warnings, on_slope, read_course
from .passages import CourseResult, MovingPoint, Passage, passages

__all__ = [
    "Course", "CourseResult", "Discipline", "Gate", "MovingPoint", "Passage", "course_names", "course_warnings",
    "on_slope", "passages", "read_course",
]  # fmt: skip
