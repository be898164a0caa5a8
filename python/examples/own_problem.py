"""A problem of one's own in ten lines: two boxes come down, one of them slides."""
import numpy as np

import ballast

W = np.eye(6)
q = np.array([[-1.0, 0.0, 0.0], [-1.0, 2.0, 0.0]])
problem = ballast.Problem.from_delassus(W, q, mu=[0.5, 0.5])
answer = ballast.solve(problem, tolerance=1e-10)
print(answer.verdict, answer.impulses.tolist())
print("worst contact", ballast.judge(problem, answer.impulses)["worst_contact"])
