"""Pictures of a plan, and a mission's review as a page and as pictures."""

from gcs_windplan.report.assessment_pictures import draw_assessment_map, draw_assessment_profile
from gcs_windplan.report.page import render_page
from gcs_windplan.report.plan_pictures import draw_map, draw_profile

__all__ = ["draw_assessment_map", "draw_assessment_profile", "draw_map", "draw_profile", "render_page"]
