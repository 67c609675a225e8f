from .planner import PlannedRoute as PlannedRoute
from .planner import plan_route as plan_route
from .planner import plan_routes as plan_routes
from .request import Request as Request
