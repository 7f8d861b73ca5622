"""What the module Palpate is made of: logic.py knows neither Slicer nor VTK, nodes.py makes all calls of them."""
