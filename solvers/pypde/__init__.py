"""The waves as py-pde equations, and their steppers as py-pde solvers."""
