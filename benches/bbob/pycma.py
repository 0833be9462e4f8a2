"""The same as farsa-bbob by pycma: `pycma.py BUDGET DIMENSION...`. Needs the packages cma and coco-experiment."""

import sys
import warnings

warnings.filterwarnings("ignore")
import cma  # noqa: E402
import cocoex  # noqa: E402


def solve(problem, seed, most):
    """IPOP restarts until the target is hit or so many evaluations are made."""
    population = 4 + int(3 * __import__("math").log(problem.dimension))
    run = 0
    while True:
        options = {"seed": seed + 1000 * run, "verbose": -9, "popsize": population * 2**run}
        search = cma.CMAEvolutionStrategy(problem.dimension * [0.0], 2.0, options)
        while not search.stop():
            points = search.ask()
            values = []
            for point in points:
                values.append(problem(point))
                if problem.final_target_hit:
                    return True
                if problem.evaluations >= most:
                    return False
            search.tell(points, values)
        run = min(run + 1, 9)


def main():
    budget, dimensions = int(sys.argv[1]), sys.argv[2:]
    print("dimension,function,instance,evaluations,hit")
    for dimension in dimensions:
        options = f"dimensions: {dimension} function_indices: 1-2,5-18 instance_indices: 1-15"
        for problem in cocoex.Suite("bbob", "instances: 1-15", options):
            _, function, instance, _ = problem.id.split("_")
            instance = int(instance[1:])
            hit = solve(problem, 1 + instance, budget * problem.dimension)
            print(dimension, int(function[1:]), instance, problem.evaluations, int(hit), sep=",", flush=True)


if __name__ == "__main__":
    main()
