"""The Robotarium's Python interface, so that scripts written for it run here unchanged.

The Robotarium is a remote laboratory of small wheeled robots (Wilson et al., The Robotarium:
Globally Impactful Opportunities, Challenges, and Lessons Learned in Remote-Access, Distributed
Control of Multirobot Systems, IEEE Control Systems Magazine 40(1), 2020).
"""
