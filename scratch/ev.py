"""Variants of the parameters on three seeds: rows, drift (along, aside)."""
import sys; sys.path.insert(0,'scratch')
import json, numpy as np, multiprocessing as mp
from concurrent.futures import ProcessPoolExecutor
import search4 as s
B=json.load(open('scratch/search2_best.json'))['x']
def make(**k):
    d=dict(zip(s.NAMES,s.X0)); d.update(k); return np.array([d[n] for n in s.NAMES])
def show(name,x,real,pool,seeds=(1,2,3),verbose=True,**ex):
    fs=[[pool.submit(s.work,(seed,x,*j,ex)) for j in s.JOBS] for seed in seeds]
    rows=[];costs=[];dr=[];bad={}
    for seed,f in zip(seeds,fs):
        feet={};d=[]
        for one,j in zip(f,s.JOBS):
            r=one.result()
            if r is None: print(name,'fell',seed,j[:2],flush=True); return 99,
            d.append(r.pop('drift'))
            for m,foot in r.items(): feet[s.names(j[0],j[1],m)]=foot
        feet={k:feet[k] for k in ('1.0','1.3','1.5','shorter','taller','heel','medial')}
        c,n,b,_=s.assess(feet,real); rows.append(n); costs.append(c); dr.append(d)
        for k,ok,o in b: bad.setdefault(k,[]).append((ok,o))
    full=np.array(dr); dr=full[...,0]
    print(name,'rows',rows,'cost %.2f'%np.mean(costs),'drift',' '.join('/'.join('%.2f'%v for v in one) for one in dr.T),flush=True)
    print('    along',np.round(full[...,1].mean(0),2),'aside',np.round(full[...,2].mean(0),2),'v fwd',np.round(full[...,3].mean(0),1),'left',np.round(full[...,4].mean(0),1),flush=True)
    if verbose: print('     ',{k:v for k,v in bad.items()},flush=True)
    return np.mean(costs),rows,dr
